"""What motor, gear and supply amount to at the shaft: the numbers of formats that know torques alone."""

from __future__ import annotations

from pierburg_ros.export.contents import Contents


def motor_constant(contents: Contents) -> float:
    """Torque at the shaft per current [N.m/A], and back-EMF per velocity of the shaft [V.s/rad]: k_g k_m."""
    return contents.base("gear_ratio") * contents.base("torque_constant")


def braking(contents: Contents) -> float:
    """Damping of the shorted motor [N.m.s/rad]: (k_g k_m)^2 / R."""
    return motor_constant(contents) ** 2 / contents.base("armature_resistance")


def stall_torque(contents: Contents) -> float:
    """Torque at duty 1 and standstill [N.m]."""
    return motor_constant(contents) * contents.base("supply_voltage") / contents.base("armature_resistance")


def no_load_speed(contents: Contents) -> float:
    """Velocity at duty 1 without load or friction [rad/s]."""
    return contents.base("supply_voltage") / motor_constant(contents)
