"""Whether recordings are what they are read as: one test for every fault of the table.

A wrong sign, unit, clock, delay or signal is a change of the recording under which the torques along its motion balance
far better. Where they balance as it is read, it is what it is read as. Where they do not and no change mends it,
physics is missing, and nothing is said here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.held import DESCRIBED_WITHIN, Held, Weighed
from pierburg_ros.audit.rows import Row, facts, rows
from pierburg_ros.inference.data import refuse_others
from pierburg_ros.inference.evidence import SIGNIFICANT, TIED
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

BALANCED = 0.05
"""Share of the command's variation that is left, at most, where torques balance. Measured: clean recordings of a
simulated valve leave 0.035 at most (n = 149), of a real servo, arm and motor 0.04 (n = 13); with a reversed sign
0.35 or more is left (n = 6)."""
BETTER = 0.2
"""Share of what is left as read that a fault may leave once it is undone. Measured: of the right fault 0.05 at most
(n = 16); not varied."""


def audit(recordings: Sequence[Recording], nominal: Model) -> list[Fault]:
    """Every signal of `recordings` that is not what it is read as, for an actuator like `nominal`; none if all are.

    InputError where they are recordings of another kind of actuator.
    """
    for recording in recordings:
        refuse_others(recording, nominal.actuator)
    return [fault for recording in recordings for fault in faults(Held(recording, nominal))]


def faults(held: Held) -> Iterator[Fault]:
    """What is wrong with one recording: facts of its signals, or else the fault that balances it."""
    exact = held.recording.exact
    told = [fact for fact in facts(held) if fact.signal not in exact]
    yield from told
    read = held.as_read()
    # a command that never changes has nothing that could be left
    if told or read.left <= BALANCED or np.ptp(held.recording.command.values) == 0.0:
        return
    tried = [(row, row.undone()) for row in rows(held) if row.of_times or row.signal not in exact]
    mending = [(row, undone) for row, undone in tried if mends(undone, read)]
    if mending:
        yield the_fault(held.recording, read, mending)


def mends(undone: Weighed, read: Weighed) -> bool:
    """Whether a recording balances far better once a fault is undone, and well."""
    return undone.left <= min(BALANCED, BETTER * read.left) and evidence(undone, read.left, undone.left) >= SIGNIFICANT


def evidence(undone: Weighed, worse: float, better: float) -> float:
    """Evidence for what leaves less, in -2 log likelihood of effective samples."""
    return undone.effective * math.log(max(worse, 1e-12) / max(better, 1e-12))


def the_fault(recording: Recording, read: Weighed, mending: Sequence[tuple[Row, Weighed]]) -> Fault:
    """Of all rows that mend, the one with which the actuator as described balances best; of those alike the first."""
    least = min((undone for _, undone in mending), key=lambda each: each.described)
    alike = [pair for pair in mending if evidence(least, pair[1].described, least.described) <= TIED]
    same = [pair for pair in alike if pair[0].mend == alike[0][0].mend]
    row, undone = min(same, key=lambda pair: pair[1].described)
    words = (
        f"The actuator, its numbers free within a factor of {DESCRIBED_WITHIN:g}, and every effect that it may have"
        f" leave {100.0 * read.left:.3g} % of the {recording.input}'s variation as it is read,"
        f" {100.0 * undone.left:.2g} % once that is mended, in {undone.effective:.0f} independent samples."
    )
    others = [f"{other.mend} ({other.signal} {other.what})" for other, _ in alike if other.signal != row.signal]
    words += f" As well does {others[0]}." if others else ""
    return Fault(recording.name, row.signal, row.what, words, row.mend)
