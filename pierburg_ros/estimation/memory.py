"""How fast an error of the input moves a simulated shaft, and how long that lasts."""

from __future__ import annotations

import math

from pierburg_ros.plant import Model
from pierburg_ros.plant.braking import braking


def top_speed(model: Model) -> float:
    """Speed of the free shaft at full duty [rad/s], at which the back-EMF is all of the supply voltage.

    Under other drives it is what the load makes of a large torque.
    """
    return model.scales.angle / model.scales.time


def memory(model: Model) -> float:
    """Time constant [s] with which the spring takes an error of the angle back, infinite without a spring."""
    stiffness = model.values.get("spring_stiffness", 0.0)
    return braking(model) / stiffness if stiffness > 0.0 else math.inf
