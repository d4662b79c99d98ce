"""What no recording of a current or torque and a motion tells: the size of all torques together."""

from __future__ import annotations

from pierburg_ros.actuators.actuator import Actuator

FACTOR = {"torque": "torque_scale", "current": "torque_constant"}
"""What multiplies the input, by the drive."""
GEAR = "gear_ratio"
"""What multiplies it as well."""
TORQUES = ("N.m", "kg.m^2")
"""How units of a torque, and of what turns motion into one, begin."""


def scaling(actuator: Actuator) -> tuple[str, ...]:
    """What multiplies the input of an actuator and nothing else; none where a voltage drives it."""
    factor = FACTOR.get(actuator.drive)
    return tuple(name for name in (factor, GEAR) if factor and name in actuator.parameters)


def in_ratio(actuator: Actuator, name: str) -> tuple[str, ...]:
    """The fixed numbers of which recordings tell only the ratio to the parameter called `name`.

    With the factor of the input and all torques larger alike the same motion comes out. A voltage has a back-EMF, which
    is no torque, and gives the size away.
    """
    if name != FACTOR.get(actuator.drive):
        return ()
    fixed = (other for other in actuator.parameters if other not in actuator.free)
    return tuple(other for other in fixed if actuator.parameters[other].unit.startswith(TORQUES) and other != name)
