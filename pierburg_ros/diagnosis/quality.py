"""The quality of recordings before anything is concluded from them, and which questions it leaves open."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.actuators.wording import place
from pierburg_ros.arrays import Flags
from pierburg_ros.audit import Fault
from pierburg_ros.diagnosis.motion import INSTANT, Motion, motion_of
from pierburg_ros.diagnosis.schema import DataQuality
from pierburg_ros.inference.data import GAP, Run, data_of
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

Kind = Literal[
    "no_movement",
    "constant_duty",
    "saturated",
    "short",
    "slow_sampling",
    "gaps",
    "one_direction",
    "closed_stop",
    "open_stop",
    "little_travel",
]

SHORT_RECORDING = 105.0
"""Duration below which rare events and slow changes are not detected, in the actuator's own time. Chosen: 10 s for the
valve; it adds advice and decides no verdict."""
SLOW_SAMPLING = 9.5
"""Samples in the actuator's own time below which delays and lags that matter cannot be distinguished from other errors.
Derived: one sample period of the valve is then 10 ms, the delay itself. It adds advice and decides no verdict."""
WANTED = 5.0
"""Recommended sampling rate, in multiples of the slowest sufficient one. Given: it is 500 Hz for the valve."""
SATURATED = 0.9
"""Share of time at full duty from which a recording counts as saturated throughout. Chosen: a tenth of the time is left
to identify friction and spring; not varied."""
MOST_GAPS = 0.02
"""Share of time in gaps above which they count as many. Chosen: it adds advice and decides no verdict."""
SHORT_TRAVEL = 0.22
"""Share of the travel below which effects that depend on the angle are not detected. Chosen: 20 degrees for the valve;
it adds advice and decides no verdict."""

RECORD: dict[Kind, str] = {
    "no_movement": "Record again with {input} steps large enough to move the shaft both ways.",
    "constant_duty": "Record again with {input} steps of several sizes.",
    "saturated": "Record again with {input} steps well within the limits, up and down.",
    "short": "Record a minute, with movements in both directions: less does not show what is rare or grows with time.",
    "slow_sampling": "Record with a shorter sample period: short delays and lags do not show.",
    "gaps": "Samples are missing: record on an idle machine, or with the recorder's queue made longer.",
    "one_direction": "To tell friction from the load, record movements both ways over the same angles.",
    "little_travel": "To see what depends on the angle, record movements over the whole travel.",
    "closed_stop": "To see whether the closed stop gives and the sensor is right there, record a return to it at"
    " {input} 0, then press against it with negative {input}.",
    "open_stop": "To see whether the open stop gives and the sensor is right there, record a run to it, and press"
    " against it with more and less {input}.",
}
"""What to record next to remove each limit; `{input}` is what drives the actuator."""


@dataclass(frozen=True)
class Limit:
    """A property of the recordings that leaves questions open; `finding` says in words which of both."""

    kind: Kind
    finding: str
    decisive: bool = False
    """Whether it prevents every conclusion about the physics."""
    input: str = "duty"
    """What drives the actuator."""

    @property
    def record(self) -> str:
        """What to record next to remove this limit."""
        return RECORD[self.kind].format(input=self.input)


def data_quality(
    runs: Sequence[Run],
    actuator: Actuator,
    noise: float,
    limits: Sequence[Limit] = (),
    remarks: Sequence[str] = (),
) -> DataQuality:
    """Sampling, saturation, stops and excitation of all `runs`, their `limits`, and the `remarks` on dirty ones.

    `noise` is the standard deviation of the noise, measured unit.
    """
    motions = [motion_of(run, actuator, noise) for run in runs]
    intervals = np.concatenate([np.diff(run.time) for run in runs])
    median = float(np.median(intervals))
    regular = intervals[intervals <= GAP * median]
    full = np.concatenate([_at_limit(motion) for motion in motions])
    return DataQuality(
        rate=float(f"{1.0 / median:.6g}"),
        jitter=round(float(np.std(regular)), 9),
        gaps=int(np.count_nonzero(intervals > GAP * median)),
        saturated_share=float(np.mean(full)),
        stops_touched=[end for end in ("closed", "open") if _touched(motions, end)],
        resolution=_resolution(runs),
        excited=excited(motions),
        limits=[limit.finding for limit in limits],
        dirt=list(remarks),
    )


def limits_of(runs: Sequence[Run], actuator: Actuator, noise: float) -> list[Limit]:
    """All limits to what these runs can show, most serious first."""
    motions = [motion_of(run, actuator, noise) for run in runs]
    limits = [
        *_limits_of_movement(motions, runs, noise),
        *_limits_of_sampling(runs, actuator),
        *_limits_of_reach(motions),
    ]
    return [replace(limit, input=actuator.input) for limit in limits]


def untelling(recordings: Sequence[Recording], nominal: Model) -> list[Fault]:
    """What prevents every conclusion about the physics, none where nothing does; InputError if they cannot be used."""
    data = data_of(recordings, nominal)
    names, told = ", ".join(recording.name for recording in recordings), "tells nothing of the physics"
    limits = [limit for limit in limits_of(data.runs, nominal.actuator, data.noise) if limit.decisive]
    return [Fault(names, limit.input, told, limit.finding, limit.record) for limit in limits]


def _limits_of_movement(motions: Sequence[Motion], runs: Sequence[Run], noise: float) -> list[Limit]:
    limits = []
    command, driven_by = np.concatenate([motion.command for motion in motions]), motions[0].actuator.input
    if not any(np.any(motion.moving) for motion in motions):
        travel = max(float(np.ptp(run.measured)) for run in runs)
        unit = motions[0].actuator.unit
        limits.append(
            Limit(
                "no_movement",
                f"The shaft never moves (the signal spans {travel:.3g} {unit}, its noise is {noise:.2g} {unit}):"
                " nothing can be said about friction, spring, motor, transmission or timing.",
                decisive=True,
            )
        )
    if np.ptp(command) == 0.0:
        limits.append(
            Limit(
                "constant_duty",
                f"The {driven_by} is {command[0]:.3g} throughout: motor, friction and spring cannot be told apart.",
                decisive=not any(motion.reversals.size for motion in motions),
            )
        )
    full = float(np.mean(np.concatenate([_at_limit(motion) for motion in motions])))
    if full >= SATURATED:
        limits.append(
            Limit(
                "saturated",
                f"The duty is at its limit for {100 * full:.0f} % of the time: what the shaft does at smaller"
                " torques, and with it friction and spring, is not in the recording.",
                decisive=True,
            )
        )
    return limits


def _limits_of_sampling(runs: Sequence[Run], actuator: Actuator) -> list[Limit]:
    limits, scales = [], actuator.scales
    duration = sum(float(run.time[-1] - run.time[0]) for run in runs)
    intervals = np.concatenate([np.diff(run.time) for run in runs])
    median = float(np.median(intervals))
    if duration < SHORT_RECORDING * scales.time:
        limits.append(
            Limit(
                "short",
                f"Only {duration:.3g} s are recorded: rare events and anything that grows with time stay unseen,"
                " and little is left to judge a fit on.",
            )
        )
    if scales.time / median < SLOW_SAMPLING:
        limits.append(
            Limit(
                "slow_sampling",
                f"The signal is sampled at {_hertz(1.0 / median, 3)}: short delays and lags cannot be told apart (they"
                f" could at {_hertz(WANTED * SLOW_SAMPLING / scales.time, 2)}).",
            )
        )
    lost = float(np.sum(intervals[intervals > GAP * median]))
    if lost > MOST_GAPS * duration:
        limits.append(Limit("gaps", f"Samples are missing for {lost:.3g} s: events in these gaps stay unseen."))
    return limits


def _limits_of_reach(motions: Sequence[Motion]) -> list[Limit]:
    limits = []
    moved = [motion for motion in motions if np.any(motion.moving)]
    if not moved:
        return []
    directions = {float(sign) for motion in moved for sign in np.sign(motion.velocity[motion.moving])}
    if len(directions) == 1:
        ways = ("opens", "closes") if moved[0].actuator.has_stops else ("goes forwards", "goes backwards")
        way = ways[0] if directions == {1.0} else ways[1]
        limits.append(Limit("one_direction", f"The shaft only {way}: friction cannot be told from spring and load."))
    travel = _span(motions)
    if travel[1] - travel[0] < SHORT_TRAVEL * motions[0].scales.angle:
        reach = place(travel[1] - travel[0], travel[1] - travel[0], motions[0].actuator.motion)
        limits.append(Limit("little_travel", f"The shaft travels {reach}: what depends on the angle stays unseen."))
    actuator = motions[0].actuator
    for end, stop in (("closed", actuator.lower_stop), ("open", actuator.upper_stop)):
        if math.isfinite(stop) and not _touched(motions, end):
            limits.append(
                Limit(
                    "closed_stop" if end == "closed" else "open_stop",
                    f"The {end} stop is never touched: its compliance, and an offset or span error of the sensor"
                    " there, cannot be seen.",
                )
            )
    return limits


def excited(motions: Sequence[Motion]) -> str:
    """How the shaft was moved and how far, in words."""
    actuator, command = motions[0].actuator, np.concatenate([motion.command for motion in motions])
    ways = {float(sign) for motion in motions for sign in np.unique(motion.direction) if sign != 0.0}
    direction = {0: "no movement", 1: "one direction"}.get(len(ways), "both directions")
    fastest = max(float(np.max(np.abs(motion.velocity), initial=0.0)) for motion in motions)
    parts = [
        f"{'angle' if actuator.motion == 'rotary' else 'position'} {place(*_span(motions), actuator.motion)}",
        direction,
        _counted(sum(motion.reversals.size for motion in motions), "reversal"),
        _counted(sum(motion.departures.size for motion in motions), "start") + " from standstill",
        f"up to {fastest:.3g} {actuator.shown('rad/s')}",
        f"{actuator.input} {np.min(command):.2f} to {np.max(command):.2f}",
    ]
    if math.isfinite(actuator.lower_stop):
        pulled = any(np.any(motion.closed & (motion.command < 0.0)) for motion in motions)
        parts.append(f"negative {actuator.input} at the closed stop: {'yes' if pulled else 'no'}")
    return ", ".join(parts)


def _hertz(rate: float, digits: int) -> str:
    """A rate rounded to so many digits, without an exponent."""
    return f"{float(f'{rate:.{digits}g}'):g} Hz"


def _at_limit(motion: Motion) -> Flags:
    """Whether the input is at its limit, shape (samples,): a duty by its magnitude, another input never."""
    full = np.abs(motion.command) >= 0.999 if motion.actuator.input == "duty" else np.zeros(motion.time.size)
    return np.asarray(full, dtype=np.bool_)


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _span(motions: Sequence[Motion]) -> tuple[float, float]:
    """Smallest and largest angle [rad]."""
    return min(float(m.angle.min()) for m in motions), max(float(m.angle.max()) for m in motions)


def _touched(motions: Sequence[Motion], end: str) -> bool:
    held = [(m.time, m.closed if end == "closed" else m.open) for m in motions]
    return any(float(np.sum(np.diff(time)[on[1:] & on[:-1]])) >= INSTANT * motions[0].scales.time for time, on in held)


def _resolution(runs: Sequence[Run]) -> float:
    """Smallest step between measured values, measured unit."""
    steps = np.diff(np.unique(np.concatenate([run.measured for run in runs])))
    return float(np.min(steps)) if steps.size else math.nan
