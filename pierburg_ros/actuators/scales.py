"""The actuator's own scales: every number of the package with a unit is a multiple of one of them.

Units are a gauge. With all torques and currents a hundred times larger, or all times ten times longer, the same
signals come out, and whatever is said of them must come out too. So ranges, starts, steps and thresholds are declared
as multiples of the scale of their unit, and never in N.m, rad or s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from pierburg_ros.effects import COPPER

if TYPE_CHECKING:
    from pierburg_ros.actuators.actuator import Actuator

READING = "reading"
"""What stands for the unit of the measured quantity, whichever it is."""


@dataclass(frozen=True)
class Scales:
    """What is large for an actuator: one number for each base unit; `reading` is that of the measured quantity."""

    torque: float
    """[N.m]: of the stalled motor at full voltage; under other drives that of the load."""
    angle: float
    """[rad]: between the stops, or what stands in their place."""
    time: float
    """[s]: over `angle` at the speed of the unloaded motor; under other drives at that which `torque` reaches."""
    voltage: float
    """[V]: of the supply."""
    current: float
    """[A]: of the stalled motor at full voltage."""
    temperature: float
    """[K]: rise that doubles the resistance of the winding."""
    reading: float
    """[V], [rad] or [rad/s]: change of the measured quantity over `angle`."""

    @staticmethod
    def of(actuator: Actuator) -> Scales:
        """The scales of `actuator`, from its nominal numbers."""
        value = {name: parameter.nominal for name, parameter in actuator.parameters.items()}
        per_current = value.get("gear_ratio", 1.0) * value.get("torque_constant", 1.0)
        if actuator.drive == "voltage":
            voltage, current = value["supply_voltage"], value["supply_voltage"] / value["armature_resistance"]
            torque, speed = per_current * current, voltage / per_current
            angle = _angle(actuator, value, torque, speed)
        else:
            torque = _load_torque(actuator, value, per_current)
            angle = _angle(actuator, value, torque, 0.0)
            speed = math.sqrt(angle * torque / value["total_inertia"])
            current, voltage = torque / per_current, torque * speed / (torque / per_current)
        return Scales(
            torque, angle, angle / speed, voltage, current, 1.0 / COPPER, _reading(actuator, value, angle, speed)
        )

    def of_unit(self, unit: str) -> float:
        """The scale of a number with this unit, such as `N.m.s/rad`; KeyError where a unit is unknown."""
        over, *under = unit.split("/")
        return self._product(over) / math.prod(self._product(part) for part in under)

    def _product(self, part: str) -> float:
        """The scale of a product of powers of units, such as `kg.m^2`."""
        factors = (factor.partition("^") for factor in part.split("."))
        return math.prod(self._units[name] ** int(power or 1) for name, _, power in factors)

    @cached_property
    def _units(self) -> dict[str, float]:
        """Scale by unit. A metre has none of its own: N.m is a torque, and kg.m^2 what torque accelerates."""
        power = self.voltage * self.current
        return {
            "1": 1.0,
            "N": self.torque,
            "m": 1.0,
            "kg": self.torque * self.time**2 / self.angle,
            "rad": self.angle,
            "s": self.time,
            "Hz": 1.0 / self.time,
            "V": self.voltage,
            "A": self.current,
            "ohm": self.voltage / self.current,
            "H": self.voltage * self.time / self.current,
            "K": self.temperature,
            "W": power,
            "J": power * self.time,
            READING: self.reading,
        }


def _load_torque(actuator: Actuator, value: dict[str, float], per_current: float) -> float:
    """What is a large torque [N.m] for a drive without a voltage, which has no stall: the load's, or the winding's.

    The weight of a pendulum; a spring at its stop, or its preload without one; what the rated current gives; ten times
    the friction. Where none of these is known, what turns a shaft on a spring round, or a free one in a second.
    """
    if value.get("gravity_torque"):
        return value["gravity_torque"]
    travel, stiffness = actuator.upper_stop - actuator.lower_stop, value.get("spring_stiffness", 0.0)
    if sprung := abs(value.get("spring_preload", 0.0)) + (stiffness * travel if math.isfinite(travel) else 0.0):
        return sprung
    if actuator.winding is not None and actuator.drive == "current":
        return per_current * actuator.winding.rated_current
    return 10.0 * value["coulomb_friction"] or 2.0 * math.pi * (stiffness or value["total_inertia"])


def _reading(actuator: Actuator, value: dict[str, float], angle: float, speed: float) -> float:
    """Change of the measured quantity over a large `angle` [rad], or at a large `speed` [rad/s]."""
    if actuator.quantity == "hall_voltage":
        return abs(value["hall_voltage_open"] - value["hall_voltage_closed"]) * angle / actuator.sensor_span
    return speed if actuator.quantity == "speed" else angle


def _angle(actuator: Actuator, value: dict[str, float], torque: float, speed: float) -> float:
    """What is a large angle [rad]: the travel between stops; without them what the load makes of the full torque.

    A pendulum turns upright by its own nature. A spring gives way to the large torque so far; a free shaft goes so far
    at full `speed` [rad/s] while it runs up to it, and a full turn where the drive knows no full speed.
    """
    travel = actuator.upper_stop - actuator.lower_stop
    if math.isfinite(travel):
        return travel
    if value.get("gravity_torque"):
        return math.pi / 2
    if value.get("spring_stiffness"):
        return torque / value["spring_stiffness"]
    return value["total_inertia"] * speed / torque * speed if speed else 2.0 * math.pi
