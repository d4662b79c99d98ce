"""An actuator as data: what drives and loads it, where it stops, what its sensor gives, and its nominal numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

from pierburg_ros.actuators.scales import READING, Scales
from pierburg_ros.actuators.units import Motion, unit_of
from pierburg_ros.effects import DECLARED
from pierburg_ros.effects.effect import Drive, Effect, Load, Sensor
from pierburg_ros.parameter import Parameter

Input = Literal["duty", "current", "torque"]

INPUT: dict[Drive, Input] = {"voltage": "duty", "current": "current", "torque": "torque"}
"""What drives the actuator: a signed duty [1] of the supply voltage, a current [A], or a torque at the output [N.m]."""
SENSED = {"hall_voltage": "V", "position": "rad", "speed": "rad/s"}
"""Unit of what each sensor gives, of a rotary actuator."""

UNITS = {
    "armature_resistance": ("ohm", "resistance of the armature winding, R"),
    "torque_constant": ("N.m/A", "motor torque per current, equal to the back-EMF constant, k_m"),
    "gear_ratio": ("1", "motor turns per shaft turn, k_g"),
    "spring_stiffness": ("N.m/rad", "rate of the return spring, k_s"),
    "spring_preload": ("N.m", "torque of the return spring at angle 0"),
    "gravity_torque": ("N.m", "weight times lever arm: load gravity_torque sin(angle), angle 0 hanging down"),
    "coulomb_friction": ("N.m", "sliding friction at the shaft, T_c"),
    "total_inertia": ("kg.m^2", "inertia seen at the shaft, J_t"),
    "supply_voltage": ("V", "supply of the motor driver"),
    "hall_voltage_closed": ("V", "Hall voltage at angle 0"),
    "hall_voltage_open": ("V", "Hall voltage at angle pi/2"),
    "torque_scale": ("1", "torque at the output per recorded torque"),
    "sensor_scale": ("1", "measured change per true one"),
    "sensor_offset": ("rad", "measured value where the true one is 0"),
}
"""Unit and meaning of each base parameter of an actuator."""


def unit_of_effect(name: str, quantity: Sensor, motion: Motion) -> str:
    """Unit of an effect's parameter by its dotted name: a converter's step is a reading, a wave's phase no travel."""
    declared = DECLARED[name]
    if declared.measure == READING:
        return unit_of(SENSED[quantity], motion)
    return declared.unit if declared.measure else unit_of(declared.unit, motion)


@dataclass(frozen=True)
class NominalParameter(Parameter):
    """A base parameter; its default is the nominal value."""

    free: bool = True
    """Whether a fit may change it."""
    fixed_by: str = ""
    """What makes it known where no fit may change it, or what it cannot be told from."""

    @property
    def nominal(self) -> float:
        """The nominal value, in the unit."""
        assert isinstance(self.default, float)
        return self.default


@dataclass(frozen=True)
class Winding:
    """Thermal constants for the stall protection; not validated where the description says no origin."""

    rated_current: float
    """Current that the winding bears for ever [A]."""
    time_constant: float
    """Time constant of its heat [s]."""
    origin: str = ""


@dataclass(frozen=True)
class Actuator:
    """What is simulated. Stops in rad, infinite where there are none; `effects` act in the nominal description too.

    All of a linear actuator is in m and N where that of a rotary one is in rad and N.m. `quantity` is what the sensor
    gives, `joint` its name in joint_states.
    """

    name: str
    title: str
    load: Load
    quantity: Sensor
    parameters: dict[str, NominalParameter]
    lower_stop: float = -math.inf
    upper_stop: float = math.inf
    effects: dict[str, dict[str, float]] = field(default_factory=dict)
    drive: Drive = "voltage"
    motion: Motion = "rotary"
    joint: str = ""
    winding: Winding | None = None
    description: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)
    """The content of the user's own file that describes it; None where the package ships it, or code made it."""

    def __repr__(self) -> str:
        return f"Actuator({self.name}: {self.title})"

    @property
    def input(self) -> Input:
        """What drives it, as recordings call it."""
        return INPUT[self.drive]

    @property
    def has_stops(self) -> bool:
        """Whether anything ends its travel."""
        return math.isfinite(self.lower_stop) or math.isfinite(self.upper_stop)

    @property
    def forgets(self) -> bool:
        """Whether it forgets its initial state: a spring or a closed bridge brings it back."""
        return self.load == "spring" or self.drive == "voltage"

    def obstacle(self, effect: Effect) -> str:
        """Why `effect` cannot act in this actuator, in words; nothing where it can."""
        return effect.obstacle(self.drive, self.load, self.quantity, self.has_stops)

    @property
    def sensor_span(self) -> float:
        """Angle between the two Hall end voltages [rad]; of a linear actuator its upper stop, or 1 m without one."""
        if self.motion == "rotary":
            return math.pi / 2
        return self.upper_stop if math.isfinite(self.upper_stop) else 1.0

    @cached_property
    def scales(self) -> Scales:
        """What is large for it as described."""
        return Scales.of(self)

    @property
    def unit(self) -> str:
        """Unit of the measured quantity."""
        return self.shown(SENSED[self.quantity])

    def shown(self, unit: str) -> str:
        """A declared `unit` as this actuator has it: every output says it so."""
        return unit_of(unit, self.motion)

    def unit_of(self, name: str) -> str:
        """Unit of the parameter with this dotted name."""
        own = self.parameters.get(name)
        return self.shown(own.unit) if own else unit_of_effect(name, self.quantity, self.motion)

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the base parameters that a fit may change."""
        return tuple(name for name, parameter in self.parameters.items() if parameter.free)
