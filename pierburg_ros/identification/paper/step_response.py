"""The paper's fit of steps from rest, equations (10) to (12), and the parameters that follow from it.

Equation (11) is used with exp(-p t). With the printed exp(p t) nothing would decay, since p1 p2 = omega_n^2 and p1 + p2
= 2 xi omega_n need positive poles (section 1 of docs/contract.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.identification.paper.holds import STOP_MARGIN, angle_of
from pierburg_ros.identification.paper.static_characteristic import StaticCharacteristic
from pierburg_ros.recording import Recording

FASTEST = 1e5
"""Largest pole that is tried, over the actuator's own time. Derived: 1e6 rad/s for the valve, 15 times the fast pole of
Table I, 66 krad/s. One sample at 500 Hz is 2,000 of its time constants: no recording shows more."""


REST = 0.21
"""Time before a step in which the shaft must rest, in the actuator's own time. Chosen: 20 ms for the valve, ten
samples; not varied."""
SHORTEST_RESPONSE = 5.2
"""Length of the shortest step that is fitted, in the actuator's own time. Chosen: half a second for the valve, less
than half of its time constant; not varied."""


@dataclass(frozen=True)
class Step:
    """A step of duty from rest on the closed stop: `duty` [1], time since the step [s], angle [rad]."""

    duty: float
    time: Signal
    angle: Signal


@dataclass(frozen=True)
class StepResponse:
    """Fitted `gain` K [rad/V] and `slow_pole` p1 [rad/s] with their standard deviations.

    `fast_pole_bound` [rad/s]: the fast pole is above it with 95 % confidence. No upper bound exists, so neither J_t nor
    omega_n and xi follow from the steps. `rmse` [rad] is over all `steps`.
    """

    gain: float
    gain_deviation: float
    slow_pole: float
    slow_pole_deviation: float
    fast_pole_bound: float
    rmse: float
    steps: tuple[Step, ...]


def second_order(time: Signal, slow: float, fast: float) -> Signal:
    """Equation (11) for a unit step and unit gain, with poles `slow` and `fast` [rad/s], both positive."""
    return np.asarray(1.0 + fast / (slow - fast) * np.exp(-slow * time) - slow / (slow - fast) * np.exp(-fast * time))


def steps_from_rest(recording: Recording, actuator: Actuator) -> list[Step]:
    """The steps of duty that open the shaft from rest on the closed stop, each until the duty changes again."""
    angle, own = angle_of(recording, actuator), actuator.scales
    margin, found = STOP_MARGIN * own.angle, []
    times = [*recording.command.time, np.nextafter(recording.time[-1], np.inf)]
    for start, end, duty in zip(times[:-1], times[1:], recording.command.values, strict=True):
        inside = (recording.time >= start) & (recording.time < end)
        before = (recording.time < start) & (recording.time >= start - REST * own.time)
        if end - start < SHORTEST_RESPONSE * own.time or not before.any() or np.mean(angle[before]) > 0.5 * margin:
            continue
        open_stop = angle[inside] > actuator.upper_stop - margin
        length = int(np.argmax(open_stop)) if open_stop.any() else open_stop.size
        step = Step(float(duty), recording.time[inside][:length] - start, angle[inside][:length])
        if length > 10 and step.angle[-1] > 2.0 * margin:
            found.append(step)
    return found


def step_response(
    recordings: Sequence[Recording], actuator: Actuator, static: StaticCharacteristic | None, supply: float
) -> StepResponse | None:
    """The fit of equation (12) to all steps from rest, with the `supply` voltage [V] given; None without steps."""
    found = [step for recording in recordings for step in steps_from_rest(recording, actuator)]
    if not found or static is None:
        return None
    fastest = FASTEST / actuator.scales.time
    still = static.preload_duty.value + static.coulomb_duty.value
    voltage = [(step.duty - still) * supply for step in found]

    def residual(logarithms: Signal) -> Signal:
        gain, slow, fast = np.exp(logarithms)
        parts = [
            u * gain * second_order(step.time, slow, fast) - step.angle for u, step in zip(voltage, found, strict=True)
        ]
        return np.concatenate(parts)

    start = np.log([static.gain.value / supply, 1.0 / static.time_constant, 0.5 * fastest])
    best = optimize.least_squares(
        lambda two: residual(np.array([*two, start[2]])), start[:2], x_scale="jac", ftol=1e-12
    )
    variance = 2.0 * best.cost / max(best.fun.size - 2, 1)
    deviation = np.sqrt(np.diagonal(np.linalg.inv(best.jac.T @ best.jac)) * variance)
    gain, slow = np.exp(best.x)
    return StepResponse(
        float(gain),
        float(gain * deviation[0]),
        float(slow),
        float(slow * deviation[1]),
        _fast_pole_bound(residual, best.x, variance, fastest),
        float(np.sqrt(np.mean(best.fun**2))),
        tuple(found),
    )


def _fast_pole_bound(residual: Callable[[Signal], Signal], point: Signal, variance: float, fastest: float) -> float:
    """Fast pole [rad/s] whose misfit, with gain and slow pole refitted, is 3.84 variances above the best."""

    def excess(fast: float) -> float:
        fitted = optimize.least_squares(lambda two: residual(np.array([*two, fast])), point, ftol=1e-12)
        return float(2.0 * fitted.cost)

    least = excess(np.log(fastest))
    low, high = point[1] + np.log(2.0), np.log(fastest)
    for _ in range(25):
        middle = 0.5 * (low + high)
        if excess(middle) - least > 3.84 * variance:
            low = middle
        else:
            high = middle
    return float(np.exp(high))


def primitive_parameters(
    response: StepResponse, static: StaticCharacteristic, values: dict[str, float]
) -> dict[str, float]:
    """Torque constant, spring stiffness, preload and friction as the paper derives them.

    From K = k_g k_m / (R k_s), 1/p1 + 1/p2 = (k_g k_m)^2 / (R k_s) and equation (9), given R
    (`armature_resistance` [ohm], measured at rest), `gear_ratio` and `supply_voltage` [V] in `values`.
    """
    resistance, ratio, supply = (values[name] for name in ("armature_resistance", "gear_ratio", "supply_voltage"))
    constant = 1.0 / (response.slow_pole * response.gain)
    torque = constant * supply / resistance
    return {
        "torque_constant": constant / ratio,
        "spring_stiffness": constant / (resistance * response.gain),
        "spring_preload": static.preload_duty.value * torque,
        "coulomb_friction": static.coulomb_duty.value * torque,
    }
