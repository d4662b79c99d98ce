"""A setpoint in place of the input: the shaft goes where the "input" says, as one that is controlled does."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.explained import Explained
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded

FOLLOWING = (0.1, 0.3, 1.0, 3.0)
"""Time constants with which a controlled shaft follows its setpoint, in times in which it crosses its travel. Chosen: a
loop that is slower does not follow."""
FOLLOWED = 0.9
"""Share of the motion that a followed setpoint explains, at least. Chosen: a tenth is left to overshoot."""
BETTER = 0.5
"""Share of what the actuator leaves unexplained that a followed setpoint may leave. Chosen: half; a motor whose angle
happens to follow its input leaves next to nothing as a motor."""
UNITY = 0.15
"""How far the angle that one unit of the setpoint gives may be from 1 rad. Chosen: a controller that misses by more is
none."""


def followed(signals: Signals, given: Explained | None, nominal: Model) -> Fault | None:
    """The input is a wanted angle: the measured one follows it, radian by radian or as a share of the travel."""
    if signals.quantity == "speed":
        return None
    angle = decoded(nominal, signals.measured, signals.quantity)
    wanted = signals.command
    if signals.setpoints is not None and np.ptp(wanted) > 0.0:
        same = signals.setpoints.at(signals.time)
        if np.ptp(same) > 0.0 and np.corrcoef(wanted, same)[0, 1] > 1.0 - 1e-6:
            return _fault(signals, "It equals the recorded setpoints.")
    travel = nominal.actuator.upper_stop - nominal.actuator.lower_stop
    for times in FOLLOWING:
        behind = _lagged(signals.time, wanted, times * nominal.scales.time)
        known = np.stack([behind, np.ones(angle.size)], axis=1)
        (gain, _), *_ = np.linalg.lstsq(known, angle, rcond=None)
        left = angle - known @ np.linalg.lstsq(known, angle, rcond=None)[0]
        share = 1.0 - float(np.var(left)) / max(float(np.var(angle)), 1e-300)
        as_angle = abs(gain - 1.0) <= UNITY or abs(gain - travel) <= UNITY * travel < math.inf
        if share >= FOLLOWED and as_angle and (given is None or 1.0 - share <= BETTER * given.cost):
            evidence = f"The shaft goes where it says, {gain:.2f} rad for 1, in {100 * share:.0f} % of the motion."
            return _fault(signals, evidence)
    return None


def _fault(signals: Signals, evidence: str) -> Fault:
    mend = f"name the applied {signals.input}: `{signals.input}: {{topic: ...}}`"
    return Fault(signals.name, signals.input, f"a setpoint in place of the {signals.input}", evidence, mend)


def _lagged(time: Signal, values: Signal, time_constant: float) -> Signal:
    """`values` behind a first-order lag [s]."""
    kept = np.exp(-np.diff(time, prepend=time[0]) / time_constant)
    result = np.empty(values.size)
    state = values[0]
    for place, (weight, value) in enumerate(zip(kept, values, strict=True)):
        state = weight * state + (1.0 - weight) * value
        result[place] = state
    return result
