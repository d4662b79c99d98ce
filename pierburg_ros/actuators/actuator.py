"""An actuator as data: what loads it, where it stops, what its sensor gives, and its nominal numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

from pierburg_ros.parameter import Parameter

Load = Literal["spring", "pendulum"]
Quantity = Literal["hall_voltage", "position"]
Unit = Literal["V", "rad"]

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
}
"""Unit and meaning of each base parameter of an actuator."""


@dataclass(frozen=True)
class NominalParameter(Parameter):
    """A base parameter; its default is the nominal value."""

    free: bool = True
    """Whether a fit may change it."""

    @property
    def nominal(self) -> float:
        """The nominal value, in the unit."""
        assert isinstance(self.default, float)
        return self.default


@dataclass(frozen=True)
class Actuator:
    """What is simulated. Stops in rad, infinite where there are none; `effects` act in the nominal description too."""

    name: str
    title: str
    load: Load
    quantity: Quantity
    parameters: dict[str, NominalParameter]
    lower_stop: float = -math.inf
    upper_stop: float = math.inf
    effects: dict[str, dict[str, float]] = field(default_factory=dict)

    @property
    def unit(self) -> Unit:
        """Unit of the measured quantity."""
        return "V" if self.quantity == "hall_voltage" else "rad"

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the base parameters that a fit may change."""
        return tuple(name for name, parameter in self.parameters.items() if parameter.free)
