"""What brakes the opening shaft in proportion to its velocity."""

from __future__ import annotations

from pierburg_ros.plant.model import Model
from pierburg_ros.plant.torques import friction


def braking(model: Model) -> float:
    """Torque per velocity [N.m.s/rad] of the back-EMF with a closed bridge, and of friction while opening.

    There is no back-EMF in a current or torque that a controller holds.
    """
    viscous = float(friction.damping(model.record()[0], 1.0, 0.0)[0])
    if model.actuator.drive != "voltage":
        return viscous
    value = model.values
    constant = value["gear_ratio"] * value["torque_constant"]
    return float(constant**2 / value["armature_resistance"] + viscous)
