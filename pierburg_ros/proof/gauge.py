"""The same actuator and recordings in other units: torques, times and angles multiplied, voltages as they are.

The equations of the plant hold in any units. So the signals of an actuator whose numbers are multiplied as their units
ask are the same, over a time and an angle that are multiplied too, and whatever is said of them has to be the same. The
power of each factor in each unit is written out here, independently of what the package takes for an actuator's scales.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from pierburg_ros.actuators import Actuator
from pierburg_ros.effects import DECLARED, STEP
from pierburg_ros.parameter import Parameter
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.recording import INPUTS, UNITS

POWERS = {
    "1": (0, 0, 0),
    "V": (0, 0, 0),
    "A": (1, -1, 1),
    "N.m": (1, 0, 0),
    "N.m/rad": (1, 0, -1),
    "N.m/rad^3": (1, 0, -3),
    "N.m.s/rad": (1, 1, -1),
    "N.m.s^2/rad^2": (1, 2, -2),
    "N.m.s^3/rad^3": (1, 3, -3),
    "kg.m^2": (1, 2, -1),
    "rad": (0, 0, 1),
    "rad/s": (0, -1, 1),
    "s": (0, 1, 0),
    "Hz": (0, -1, 0),
    "ohm": (-1, 1, -1),
    "H": (-1, 2, -1),
    "K/W": (-1, 1, -1),
    "J/K": (1, 0, 1),
}
"""Powers of torque, time and angle in each unit; electrical power is torque times angle over time."""
OWN = {"torque_constant": (0, 1, 0), "gear_ratio": (0, 0, -1)}
"""Those of two numbers of which the product alone has a unit: a shaft of larger angles turns more to a motor turn."""
PHASES = frozenset(name for name, declared in DECLARED.items() if declared.measure == "1")
"""Angles that are not the shaft's."""

Declared = TypeVar("Declared", bound=Parameter)


@dataclass(frozen=True)
class Gauge:
    """How much larger the numbers for torques, times and, where an angle is measured, angles are."""

    torque: float = 1.0
    time: float = 1.0
    angle: float = 1.0

    def factor(self, name: str, unit: str) -> float:
        """By what the number called `name` is multiplied."""
        powers = (0, 0, 0) if name in PHASES else OWN.get(name) or POWERS[unit]
        return self.torque ** powers[0] * self.time ** powers[1] * self.angle ** powers[2]

    def values(self, values: Mapping[str, float], actuator: Actuator) -> dict[str, float]:
        """Values by dotted name in these units."""
        units = {name: parameter.unit for name, parameter in actuator.parameters.items()}
        units |= {name: declared.unit for name, declared in DECLARED.items()}
        units[STEP] = UNITS[actuator.quantity]
        return {name: value * self.factor(name, units[name]) for name, value in values.items()}

    def actuator(self, actuator: Actuator) -> Actuator:
        """The description in these units."""

        def scaled(parameter: Declared) -> Declared:
            factor = self.factor(parameter.name, parameter.unit)
            assert isinstance(parameter.default, float)
            return replace(
                parameter,
                default=parameter.default * factor,
                minimum=parameter.minimum * factor,
                maximum=parameter.maximum * factor,
            )

        effects = {
            effect: {name: value * self.factor(name, DECLARED[f"{effect}.{name}"].unit) for name, value in own.items()}
            for effect, own in actuator.effects.items()
        }
        return replace(
            actuator,
            parameters={name: scaled(parameter) for name, parameter in actuator.parameters.items()},
            lower_stop=actuator.lower_stop * self.angle,
            upper_stop=actuator.upper_stop * self.angle,
            effects=effects,
        )

    def recording(self, recording: Recording) -> Recording:
        """The recording in these units."""

        def given(channel: Channel, factor: float = 1.0) -> Channel:
            return Channel(channel.time * self.time, channel.values * factor)

        return replace(
            recording,
            time=recording.time * self.time,
            measured=recording.measured * self.measured(recording.quantity),
            command=given(recording.command, self.factor(recording.input, INPUTS[recording.input])),
            supply_voltage=recording.supply_voltage and given(recording.supply_voltage),
            enabled=recording.enabled and given(recording.enabled),
        )

    def measured(self, quantity: str) -> float:
        """By what the measured values are multiplied."""
        return self.factor(quantity, UNITS[quantity])
