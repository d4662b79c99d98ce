"""The fastest any controller can be: full duty all the way to the band around the target."""

from __future__ import annotations

import math

from pierburg_ros.closed_loop.predictor import dead_time
from pierburg_ros.plant import Model

PERIODS = 2  # a sample may just have missed the setpoint, and its duty acts one sample later


def full_duty_travel_time(model: Model, start: float, end: float) -> float:
    """Time [s] from `start` to `end` [rad] at full duty; infinite if the motor never gets there.

    Sliding motion of the base parameters, without inertia (it dies out within 0.1 ms) and without effects:
    time_constant w = gain duty - angle - preload_angle - friction_angle sign(w).
    """
    value = model.values
    stiffness = value["spring_stiffness"]
    transmission = value["gear_ratio"] * value["torque_constant"]
    resistance = value["armature_resistance"]
    time_constant = transmission**2 / (resistance * stiffness)
    direction = math.copysign(1.0, end - start)
    push = transmission * value["supply_voltage"] / resistance - value["coulomb_friction"]
    goal = (direction * push - value["spring_preload"]) / stiffness
    if (goal - end) * direction <= 0.0:
        return math.inf
    return time_constant * math.log((goal - start) / (goal - end))


def settling_bound(model: Model, start: float, target: float, band: float, rate: float = 500.0) -> float:
    """Shortest settling time [s] of a step: full-duty travel to the band's edge, two sample periods, and dead time."""
    edge = target - math.copysign(band, target - start)
    return full_duty_travel_time(model, start, edge) + PERIODS / rate + dead_time(model)
