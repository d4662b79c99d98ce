"""Whether recordings are what they are read as: one test for every fault of the table.

A wrong sign, unit, clock, delay or signal is a change of the recording under which the torques along its motion balance
far better. Where they balance as it is read, it is what it is read as. Where they do not and no change mends it,
physics is missing, and nothing is said here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.held import OFF, Held, Weighed
from pierburg_ros.audit.rows import Row, facts, rows
from pierburg_ros.inference.evidence import SIGNIFICANT, TIED
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

BALANCED = 0.05
"""Share of the command's variation that is left, at most, where torques balance. Chosen."""
BETTER = 0.2
"""Share of what is left as read that a fault may leave once it is undone. Chosen."""


def audit(recordings: Sequence[Recording], nominal: Model) -> list[Fault]:
    """Every signal of `recordings` that is not what it is read as, for an actuator like `nominal`; none if all are."""
    return [fault for recording in recordings for fault in faults(Held(recording, nominal))]


def faults(held: Held) -> Iterator[Fault]:
    """What is wrong with one recording: facts of its signals, or else the fault that balances it."""
    recording = held.recording
    told = [fact for fact in facts(held) if fact.signal not in recording.exact]
    for fact in told:
        yield Fault(recording.name, fact.signal, fact.what, fact.evidence, fact.mend)
    read = held.as_read()
    if told or read.left <= BALANCED:
        return
    tried = [(row, row.undone()) for row in rows(held) if row.kept or row.signal not in recording.exact]
    mending = [(row, undone) for row, undone in tried if mends(undone, read)]
    if mending:
        best = min((undone for _, undone in mending), key=lambda each: each.left)
        alike = [(row, undone) for row, undone in mending if best.over(undone) <= TIED]
        yield fault(recording, read, *alike[0], [row for row, _ in alike[1:]])


def mends(undone: Weighed, read: Weighed) -> bool:
    """Whether a recording balances far better once a fault is undone, and well."""
    return undone.left <= min(BALANCED, BETTER * read.left) and undone.over(read) >= SIGNIFICANT


def fault(recording: Recording, read: Weighed, row: Row, undone: Weighed, alike: Sequence[Row]) -> Fault:
    """The fault that a row tells, in numbers, and what else would do as well."""
    evidence = (
        f"The actuator, its numbers free within a factor of {OFF:g}, and every effect that it may have leave"
        f" {100.0 * read.left:.3g} % of the {recording.input}'s variation as it is read, {100.0 * undone.left:.2g} %"
        f" once that is mended (evidence {undone.over(read):.0f} in {undone.effective:.0f} samples)."
    )
    others = [f"{other.mend} ({other.signal} {other.what})" for other in alike if other.signal != row.signal]
    if others:
        evidence += f" As well does {others[0]}."
    return Fault(recording.name, row.signal, row.what, evidence, row.mend)
