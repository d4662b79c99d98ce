"""Where in time a mismatch is: windows of the recording, with the motion of the shaft in each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators.wording import place
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.motion import Motion
from pierburg_ros.diagnosis.schema import Direction, Location

LONG = 10.5
"""Length from which a window is described by its beginning and its range of motion, in the actuator's own time. Chosen:
1 s for the valve; it decides a word."""
JUST_BEFORE = 5.25
"""Time within which a pull counts as just before a movement, in the actuator's own time. Chosen: half a second for the
valve; it decides a word."""
PLACE = 0.09
"""Range of angles that counts as near one angle, as a share of the travel. Chosen: 8 degrees for the valve; it decides
a word."""
PRESSING = 0.01
"""Share of a large input from which the motor presses against a stop. Chosen: it decides a word."""

ONE_DIRECTION = 0.8
"""Share of the energy in a window that must be in movements of one direction for the window to have it. Chosen: four
times as much as in the other."""


def locations(motion: Motion, residual: Signal, windows: Sequence[tuple[float, float]]) -> list[Location]:
    """`windows` (start, end) [s] with the motion of the shaft, and the share of the energy of `residual` in each.

    `residual` is that of the recalibrated nominal model on the samples of `motion`.
    """
    total = float(residual @ residual)
    late = bool(windows) and min(start for start, _ in windows) > 0.6 * motion.time[-1]
    found = []
    for start, end in windows:
        inside = _samples(motion, start, end)
        share = float(residual[inside] @ residual[inside]) / total if total > 0.0 else 0.0
        regime = doing(motion, start, end) + (", late in the recording" if late else "")
        way = direction(motion.velocity[inside] * motion.moving[inside], residual[inside])
        found.append(Location(start=start, end=end, share=share, regime=regime, direction=way))
    return found


def direction(velocity: Signal, residual: Signal) -> Direction:
    """In which direction the shaft moves where the energy of a residual is; `velocity` is 0 where it stands."""
    energy = np.square(residual)
    ways = [float(np.sum(energy[sign * velocity > 0.0])) for sign in (1.0, -1.0)]
    if ways[0] > ONE_DIRECTION * sum(ways):
        return "positive"
    return "negative" if ways[1] > ONE_DIRECTION * sum(ways) else "both"


def doing(motion: Motion, start: float, end: float) -> str:
    """What the shaft does from `start` to `end` [s], in words; for a long window how it begins and how far it goes."""
    if end - start > LONG * motion.scales.time:
        beginning = doing(motion, start, start + 0.5 * LONG * motion.scales.time)
        return f"{beginning}, then {_reach(motion, _samples(motion, start, end))}"
    inside = _samples(motion, start, end)
    if inside.size == 0:
        return "no sample"
    if not motion.moving[inside].any():
        return _standing(motion, inside)
    return _departing(motion, inside) or _arriving(motion, inside) or _travelling(motion, inside)


def _samples(motion: Motion, start: float, end: float) -> NDArray[np.intp]:
    return np.flatnonzero((motion.time >= start) & (motion.time < end))


def _standing(motion: Motion, inside: NDArray[np.intp]) -> str:
    effort = float(np.median(motion.effort[inside]))
    for end, on, push in (("closed", motion.closed, -effort), ("open", motion.open, effort)):
        if on[inside].mean() > 0.5:
            how = "pressed against" if push > PRESSING else "resting on"
            return f"{how} the {end} stop"
    return f"standstill {_near(motion, inside)}"


def _departing(motion: Motion, inside: NDArray[np.intp]) -> str | None:
    """Words for a movement that begins inside; None where none begins."""
    begins = inside[0] + np.flatnonzero(motion.moving[inside][1:] & ~motion.moving[inside][:-1]) + 1
    if motion.moving[inside[0]] and motion.time_at_rest[inside[0]] > 0.0:
        begins = np.concatenate([[inside[0]], begins])
    if begins.size == 0:
        return None
    first = int(begins[0])
    before = max(first - 1, 0)
    for end, on in (("closed", motion.closed), ("open", motion.open)):
        if on[before]:
            pulled = end == "closed" and _pulled_before(motion, first)
            return f"leaving the {end} stop" + (f" after negative {motion.actuator.input}" if pulled else "")
    turned = bool(np.isin(motion.reversals, begins).any())
    what = "reversal" if turned else "first movement after standstill"
    return f"{what}, {_way(motion, first)} {_near(motion, np.array([first]))}"


def _arriving(motion: Motion, inside: NDArray[np.intp]) -> str | None:
    for end, on in (("closed", motion.closed), ("open", motion.open)):
        if on[inside[-1]] and not on[inside[0]]:
            return f"arriving at the {end} stop"
    return None


def _travelling(motion: Motion, inside: NDArray[np.intp]) -> str:
    velocity = motion.velocity[inside]
    fastest = float(np.quantile(np.abs(motion.velocity), 0.99))
    speed = "fast" if float(np.max(np.abs(velocity))) > 0.4 * fastest else "slow"
    if np.isin(motion.reversals, inside).any():
        return f"reversal {_near(motion, inside)}"
    return f"{speed} {_way(motion, int(inside[np.argmax(np.abs(velocity))]))} {_near(motion, inside)}"


def _pulled_before(motion: Motion, first: int) -> bool:
    """Whether the input was negative at rest just before sample `first`."""
    recent = (motion.time >= motion.time[first] - JUST_BEFORE * motion.scales.time) & (motion.time < motion.time[first])
    return bool(np.any(recent & ~motion.moving & (motion.effort < -PRESSING)))


def _way(motion: Motion, sample: int) -> str:
    """The direction at a sample; forwards is where the angle grows of what has no stop to open or close."""
    ways = ("opening", "closing") if motion.actuator.has_stops else ("forwards", "backwards")
    return ways[0] if motion.velocity[sample] > 0.0 else ways[1]


def _near(motion: Motion, inside: NDArray[np.intp]) -> str:
    if motion.actuator.quantity == "speed":
        ends = dict.fromkeys(f"{f(motion.velocity[inside]):.3g}" for f in (np.min, np.max))
        return f"at {' to '.join(ends)} {motion.actuator.unit}"
    lowest, highest = (float(f(motion.angle[inside])) for f in (np.min, np.max))
    if highest - lowest < PLACE * motion.scales.angle:
        middle = (lowest + highest) / 2
        return f"near {place(middle, middle, motion.actuator.motion)}"
    return f"between {place(lowest, highest, motion.actuator.motion).replace(' to ', ' and ')}"


def _reach(motion: Motion, inside: NDArray[np.intp]) -> str:
    return _near(motion, inside) if motion.moving[inside].any() else "at rest"
