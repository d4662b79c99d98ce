"""The audit of recordings: whether their signals are what they are read as, before anything is concluded from them.

One idea: whatever physics an actuator lacks, its inputs still cause its motion. So the actuator as described, its
numbers free to drift, has to explain the better part of the motion; where it explains next to nothing, and after one
slip is undone nearly everything, that slip is a fault.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from pierburg_ros.audit.balance import made_up
from pierburg_ros.audit.explained import BRIEF, CREDIBLE, ENOUGH, FEWEST, Explained, explained
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.loop import closed_loop
from pierburg_ros.audit.reach import DOUBTFUL, impossible
from pierburg_ros.audit.servo import followed
from pierburg_ros.audit.signals import Signals
from pierburg_ros.audit.slips import Slip, between_stops, exchanged, slips
from pierburg_ros.audit.still import still
from pierburg_ros.audit.timing import early, shift, wandering
from pierburg_ros.audit.together import apart
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

MOST = 4
"""Slips, the best after a brief fit, that are fitted fully. Work: the right one has been first or second."""
PLAINLY = 0.7
"""Share of motion and correlation of velocities that a slip must explain once undone. Measured: the right slip reaches
0.77 or more of each in recordings (n = 20), another one 0.56 or less where it does not say nearly the same."""
BETTER = 0.5
"""Share of what is left unexplained as read that may be left once a slip is undone. Chosen: half; the right slip leaves
a tenth."""
LATER = "answered late"
"""What is no fault: a shaft that answers late has a delay."""
TIMED = 50_000
"""Samples that are looked at for causality, at most, as sharp edges may be rare. Work: one simulation of 100 s at 500
Hz."""
FAR_BETTER = 0.2
"""Share of the cost as read that a slip may leave where the motion is explained as it is read, too. Chosen: one effect
that is missing halves it, a wrong divider takes nine tenths."""
SENSOR = {"sensor_scale", "sensor_offset", "hall_voltage_closed", "hall_voltage_open"}
"""Numbers of an actuator that say what its sensor reads."""
ALIKE = 1.1
"""Slips that cost up to so many times as much as the best are told together. Chosen: a tenth is less than one effect
that is missing makes."""


def audit(recordings: Sequence[Recording], nominal: Model) -> list[Fault]:
    """Every signal of `recordings` that is not what it is read as, for an actuator like `nominal`; none if all are."""
    recordings = [each for each in recordings if _can_be_held(each, nominal)]
    lively = [Signals.of(recording) for recording in recordings]
    found = [explained_if_possible(signals, nominal) for signals in lively]
    faults = [
        fault
        for signals, given, recording in zip(lively, found, recordings, strict=True)
        for fault in faults_of(signals, given, nominal, recording)
    ]
    return faults or apart([(each, given) for each, given in zip(lively, found, strict=True) if given], nominal)


def explained_if_possible(signals: Signals, nominal: Model) -> Explained | None:
    """How the signals as read agree with the actuator; None where they cannot be what they are read as."""
    return None if impossible(signals, nominal) else explained(signals, nominal)


def faults_of(signals: Signals, given: Explained | None, nominal: Model, recording: Recording) -> list[Fault]:
    """What is wrong with one recording."""
    if (unmoved := still(signals, nominal)) is not None:
        return unmoved
    found = followed(signals, given, nominal) or closed_loop(signals, given, slips(signals, nominal), nominal)
    timed = Signals.of(recording, TIMED)
    if not found and given is not None:
        found = wandering(timed, signals, given, nominal)
    if not found and given is not None and given.suffices:
        found = (
            early(timed, given)
            or plainer(tuple(exchanged(signals)), signals, given, nominal)
            or rescaled(signals, given, nominal)
        )
    elif not found:
        found = mended(signals, given, nominal, recording)
    return [found] if found else []


def mended(signals: Signals, given: Explained | None, nominal: Model, recording: Recording) -> Fault | None:
    """The slip that, once undone, lets the actuator explain the motion; otherwise that nothing does.

    An input that balances the torques along a motion, or plainly causes it in another part of the recording, is the
    right one: something else has acted.
    """
    if given is not None and made_up(Signals.of(recording, TIMED), nominal):
        return None
    named = (*slips(signals, nominal), *shifted(signals, given))
    left = BETTER * given.cost if given is not None else 1.0
    found = undone(named, left, nominal) or undone(tuple(between_stops(signals, nominal)), left, nominal)
    if found:
        return None if found[0][0].what == LATER else blamed(found, signals, given, nominal)
    agrees = given is not None and min(given.share, given.agreement) >= ENOUGH
    if agrees or causes(Signals.elsewhere(recording), nominal):
        return None
    return unrelated(signals, given, nominal)


def causes(signals: Signals | None, nominal: Model) -> bool:
    """Whether the actuator plainly explains the motion by its input as it is read."""
    given = explained_if_possible(signals, nominal) if signals else None
    return given is not None and given.suffices and min(given.share, given.agreement) >= PLAINLY


def rescaled(signals: Signals, given: Explained, nominal: Model) -> Fault | None:
    """A scale or zero of the sensor, where readings lie doubtfully beyond the stops and it explains far better.

    Where these are free numbers of the actuator, the search finds them as a drift, with an interval.
    """
    if SENSOR & set(nominal.actuator.free) or not impossible(signals, nominal, DOUBTFUL):
        return None
    return plainer(tuple(between_stops(signals, nominal)), signals, given, nominal)


def plainer(candidates: Sequence[Slip], signals: Signals, given: Explained, nominal: Model) -> Fault | None:
    """The slip that, once undone, explains far better a motion that is explained as it is read, too."""
    found = undone(candidates, FAR_BETTER * given.cost, nominal)
    return blamed(found, signals, given, nominal) if found else None


def undone(candidates: Sequence[Slip], left: float, nominal: Model) -> list[tuple[Slip, Explained]]:
    """The slips that explain the motion plainly once they are undone and cost at most what is `left`, best first."""
    possible = [slip for slip in candidates if not impossible(slip.mended, nominal)]
    brief = sorted(possible, key=lambda slip: explained(slip.mended, nominal, BRIEF).cost)
    tried = [(slip, explained(slip.mended, nominal)) for slip in brief[:MOST]]
    plain = [
        (slip, found)
        for slip, found in tried
        if found.suffices and min(found.share, found.agreement) >= PLAINLY and found.cost <= left
    ]
    return sorted(plain, key=lambda pair: pair[1].cost)


def blamed(found: Sequence[tuple[Slip, Explained]], signals: Signals, given: Explained | None, nominal: Model) -> Fault:
    """The best slip, and the next one where it does as well."""
    (best, explanation), *others = found
    alike = [slip for slip, other in others if other.cost <= ALIKE * explanation.cost][:1]
    return Fault(
        signals.name,
        best.signal,
        " or ".join(_named(slip, best) for slip in (best, *alike)),
        f"{as_read(signals, given, nominal)} So mended, {telling(explanation)}.",
        " or ".join(slip.mend for slip in (best, *alike)),
    )


def unrelated(signals: Signals, given: Explained | None, nominal: Model) -> Fault:
    """No slip explains the motion: the input is not that of this motion, or the actuator is another."""
    if given is None:
        signal, _ = impossible(signals, nominal) or (signals.quantity, "")
        what, mend = (
            "cannot be what it is read as",
            f"say what it is: `{signal}: {{unit: ..., scale: ..., offset: ...}}`",
        )
    else:
        signal, what = signals.input, "does not cause the motion"
        mend = f"name the {signal} of this joint and this run: `{signal}: {{topic: ...}}`, or choose another --actuator"
    return Fault(signals.name, signal, what, as_read(signals, given, nominal), mend)


def as_read(signals: Signals, given: Explained | None, nominal: Model) -> str:
    """What is wrong with the signals as they are read, in numbers."""
    if given is None:
        return (impossible(signals, nominal) or ("", ""))[1]
    return f"As it is read, {telling(given)}."


def telling(found: Explained) -> str:
    """How much of the motion is explained, in numbers."""
    drift = f", with numbers off by a factor of {math.exp(found.drift):.3g} together" if found.drift > CREDIBLE else ""
    return (
        f"the actuator explains {max(100.0 * found.share, 0.0):.0f} % of the motion and velocities correlate by"
        f" {found.agreement:.2f}{drift}"
    )


def shifted(signals: Signals, given: Explained | None) -> Iterator[Slip]:
    """The inputs moved in time to where velocities agree best."""
    by = shift(signals, given) if given is not None else 0.0
    if by < 0.0:
        mend = f"choose the clock of the sender with --time, or record the applied {signals.input} by the same clock"
        yield Slip(signals.input, f"stamped {-by:.3g} s late", mend, signals.delayed(by))
    elif by > 0.0:
        yield Slip(signals.input, LATER, "", signals.delayed(by))


def _named(slip: Slip, best: Slip) -> str:
    return slip.what if slip.signal == best.signal else f"{slip.what} ({slip.signal})"


def _can_be_held(recording: Recording, nominal: Model) -> bool:
    """Whether the recording is long enough, and of what the actuator is driven by and measures."""
    actuator = nominal.actuator
    decodes = (recording.quantity, actuator.quantity) == ("position", "hall_voltage")
    same = recording.quantity == actuator.quantity or decodes
    return recording.time.size >= 2 * FEWEST and recording.input == actuator.input and same
