"""What motor, gear and supply amount to at the shaft: the numbers of formats that know torques alone."""

from __future__ import annotations

import math

from pierburg_ros.export.contents import Contents

INPUTS = {"voltage": "duty", "current": "current in A", "torque": "recorded torque"}
"""What drives an actuator, in words."""
NO_LIMIT = 1e16
"""What formats take for no limit."""


def motor_constant(contents: Contents) -> float:
    """Torque at the shaft per current [N.m/A], and back-EMF per velocity of the shaft [V.s/rad]: k_g k_m."""
    return contents.base("gear_ratio") * contents.base("torque_constant")


def torque_per_input(contents: Contents) -> float:
    """Torque of the motor at standstill [N.m] per duty [1], current [A] or torque [N.m], as the drive has it."""
    drive = contents.model.actuator.drive
    if drive == "torque":
        return contents.base("torque_scale")
    if drive == "current":
        return motor_constant(contents)
    return motor_constant(contents) * contents.base("supply_voltage") / contents.base("armature_resistance")


def braking(contents: Contents) -> float:
    """Damping of the shorted motor [N.m.s/rad]: (k_g k_m)^2 / R; a driven current or torque does not brake."""
    if contents.model.actuator.drive != "voltage":
        return 0.0
    return motor_constant(contents) ** 2 / contents.base("armature_resistance")


def largest_torque(contents: Contents) -> float:
    """Torque at duty 1 and standstill [N.m]; no limit where current or torque are driven."""
    return torque_per_input(contents) if contents.model.actuator.drive == "voltage" else NO_LIMIT


def largest_speed(contents: Contents) -> float:
    """Velocity at duty 1 without load or friction [rad/s]; no limit where current or torque are driven."""
    if contents.model.actuator.drive != "voltage":
        return NO_LIMIT
    return contents.base("supply_voltage") / motor_constant(contents)


def typical_torque(contents: Contents) -> float:
    """A torque [N.m] that presses the shaft against a stop: of the stalled motor, or that of load and friction."""
    if contents.model.actuator.drive == "voltage":
        return torque_per_input(contents)
    loads = ("spring_preload", "gravity_torque", "coulomb_friction")
    return math.fsum(abs(contents.base(name)) for name in loads) or 1.0
