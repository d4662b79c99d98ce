"""Reads an actuator description (YAML), shipped or a user's own, and says clearly what is wrong with it."""

from __future__ import annotations

import math
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from pierburg_ros.actuators.actuator import SENSED, UNITS, Actuator, NominalParameter, Winding, unit_of_effect
from pierburg_ros.actuators.units import Motion
from pierburg_ros.actuators.values import described
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Drive, Load, Sensor
from pierburg_ros.errors import InputError, near, printable
from pierburg_ros.intake import parsed, path_of, reading, text_of
from pierburg_ros.intake.bounds import LARGEST

SHIPPED = ("pierburg", "xl330", "ak80", "odrive")
"""Actuators that come with the package."""

_MOTOR = {"torque_constant", "gear_ratio"}
_COMMON = {"coulomb_friction", "total_inertia"}
_DRIVE: dict[str, set[str]] = {
    "voltage": _MOTOR | {"armature_resistance", "supply_voltage"},
    "current": _MOTOR,
    "torque": set(),
}
_LOAD: dict[str, set[str]] = {
    "spring": {"spring_stiffness", "spring_preload"},
    "pendulum": {"gravity_torque"},
    "none": set(),
}
POSITIVE = {
    "armature_resistance",
    "torque_constant",
    "gear_ratio",
    "total_inertia",
    "torque_scale",
    "sensor_scale",
}
"""Numbers by which equations divide."""
MAGNITUDES = {"spring_stiffness", "coulomb_friction", "supply_voltage"}
"""Numbers of which 0 is the least."""
FULL_TURN = 2.0 * math.pi
"""The zero of a sensor may be off by so much [rad], where nothing says how far the shaft can go."""
SMALLEST_VALUE = 1e-18
"""Least value that counts as above 0: the inertia of a micro-motor's rotor is 1e-14 kg.m^2."""
_SENSOR: dict[str, set[str]] = {
    "hall_voltage": {"hall_voltage_closed", "hall_voltage_open"},
    "position": set(),
    "speed": set(),
}
_GIVEN = {"position": {"sensor_scale", "sensor_offset"}, "speed": {"sensor_scale", "sensor_offset"}}
"""What a sensor has without being told: it shows the truth until a fit finds that it does not."""

FORM = "an actuator description (YAML)"


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, strict=True)


class _Parameter(_Strict):
    nominal: float
    minimum: float
    maximum: float
    origin: str = Field(min_length=1)
    free: bool = True
    fixed_by: str = Field(default="", max_length=200)

    @model_validator(mode="after")
    def _in_range(self) -> _Parameter:
        if not self.minimum <= self.nominal <= self.maximum:
            raise ValueError(f"nominal {self.nominal} is outside its range {self.minimum} to {self.maximum}")
        return self


class _Stops(_Strict):
    lower: float
    upper: float


class _Winding(_Strict):
    rated_current: float = Field(gt=0.0)
    time_constant: float = Field(gt=0.0)
    origin: str = Field(min_length=1)


class _Description(_Strict):
    name: str = Field(min_length=1, max_length=80)
    title: str = Field(default="", max_length=200)
    drive: Drive = "voltage"
    load: Load
    sensor: Sensor
    motion: Motion = "rotary"
    joint: str = Field(default="", max_length=80)
    winding: _Winding | None = None
    stops: _Stops | None = None
    parameters: dict[str, _Parameter]
    effects: dict[str, dict[str, float]] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _complete(self) -> _Description:
        self._parameters_fit()
        if self.stops and self.stops.lower >= self.stops.upper:
            raise ValueError("stops.lower must be less than stops.upper")
        self._possible()
        for effect, values in self.effects.items():
            if effect not in EFFECT:
                raise ValueError(f"effects has unknown {effect}; known: {', '.join(EFFECT)}.{near(effect, EFFECT)}")
            self._check_effect(effect, values)
        return self

    def _parameters_fit(self) -> None:
        """Refuse parameters that are missing or mean nothing with this drive, load and sensor."""
        kind = f"drive {self.drive}, load {self.load} and sensor {self.sensor}"
        needed = _COMMON | _DRIVE[self.drive] | _LOAD[self.load] | _SENSOR[self.sensor]
        optional = _GIVEN.get(self.sensor, set()) | ({"torque_scale"} if self.drive == "torque" else set())
        optional |= set() if self.load == "none" else _LOAD["spring"] | _LOAD["pendulum"]
        if missing := sorted(needed - set(self.parameters)):
            raise ValueError(f"parameters lacks {', '.join(missing)}, needed with {kind}")
        if unknown := sorted(set(self.parameters) - set(UNITS)):
            raise ValueError(
                f"parameters has unknown {', '.join(unknown)}; known: {', '.join(UNITS)}.{near(unknown[0], UNITS)}"
            )
        if idle := sorted(set(self.parameters) - needed - optional):
            raise ValueError(f"parameters has {', '.join(idle)}, without meaning with {kind}; leave it out")

    def _possible(self) -> None:
        """Refuse ranges that no actuator has: equations divide by some numbers, and others are magnitudes."""
        for name, parameter in self.parameters.items():
            if name in POSITIVE and not parameter.minimum >= SMALLEST_VALUE:
                raise ValueError(f"{name} may be {parameter.minimum:g}; expected a minimum above 0")
            if name == "supply_voltage" and not parameter.nominal > 0.0:
                raise ValueError("supply_voltage is nominally 0; expected the voltage that drives the motor")
            if name in MAGNITUDES and not parameter.minimum >= 0.0:
                raise ValueError(f"{name} may be {parameter.minimum:g}; expected a minimum of 0 or more")
            if max(abs(parameter.minimum), abs(parameter.maximum)) > LARGEST:
                raise ValueError(f"{name} may exceed {LARGEST:g}; expected a range of the actuator's own size")

    def _check_effect(self, effect: str, values: dict[str, float]) -> None:
        """Refuse an effect whose numbers are unknown or missing."""
        declared = EFFECT[effect]
        if unknown := sorted(set(values) - set(declared.names)):
            raise ValueError(f"{effect} has no parameter {', '.join(unknown)}.{near(unknown[0], declared.names)}")
        for name in declared.names:
            if name not in values and declared.parameter(name).default is None:
                unit = unit_of_effect(f"{effect}.{name}", self.sensor, self.motion)
                raise ValueError(f"{effect} lacks {name} [{unit}]")


def needed_parameters(drive: Drive, load: Load, sensor: Sensor) -> list[str]:
    """Names of the parameters that every actuator of this kind needs, in the order of `UNITS`."""
    needed = _COMMON | _DRIVE[drive] | _LOAD[load] | _SENSOR[sensor]
    return [name for name in UNITS if name in needed]


def read_actuator(source: str | Path) -> Actuator:
    """The actuator called `source` (a shipped name, or the path of a YAML file); InputError where unusable."""
    path_of(source, "the name of an actuator, or the path of its description")
    with reading(source, FORM):
        text, label = _text(source)
        content = parsed(text, label, FORM).content
        actuator = actuator_of(content, label)
    return replace(actuator, description=None) if str(source) in SHIPPED else actuator


def actuator_of(content: object, label: str) -> Actuator:
    """The actuator that the `content` of a description says; InputError, with the `label`, where it says none."""
    if not isinstance(content, dict):
        raise InputError(f"{label} holds no actuator description; expected name, load, sensor, parameters.")
    try:
        actuator = replace(_actuator(_Description.model_validate(content)), description=content)
    except ValidationError as error:
        problem = _first_problem(error)
        raise InputError(f"{label}: {problem}. Compare it with examples/my_actuator.yaml.") from None
    try:
        described(actuator)
    except InputError as error:
        raise InputError(f"{label}: {error}") from None
    return actuator


def _text(source: str | Path) -> tuple[str, str]:
    if str(source) in SHIPPED:
        file = resources.files("pierburg_ros.actuators") / f"{source}.yaml"
        return file.read_text(encoding="utf-8"), f"actuator {source}"
    path = Path(source)
    if not path.exists():
        raise InputError(
            f"There is no actuator {source}; expected {' or '.join(SHIPPED)} or the path of a YAML description."
            f"{near(str(source), SHIPPED)}"
        )
    return text_of(path, FORM), path.name


def _first_problem(error: ValidationError) -> str:
    problem: Any = error.errors()[0]
    place = ".".join(str(part) for part in problem["loc"])
    message = problem["msg"].removeprefix("Value error, ")
    return f"{place}: {message}" if place else message


def _parameter(name: str, given: _Parameter, sensor: Sensor) -> NominalParameter:
    unit, meaning = UNITS[name]
    if name == "sensor_offset":
        unit = SENSED[sensor]
    return NominalParameter(
        name,
        given.nominal,
        meaning,
        unit,
        given.minimum,
        given.maximum,
        origin=given.origin,
        free=given.free,
        fixed_by=given.fixed_by,
    )


def _sensor_parameters(description: _Description) -> dict[str, _Parameter]:
    """Scale and zero of a sensor that shows the truth, where it may be off and the description says nothing of it."""
    if description.sensor not in _GIVEN:
        return {}
    stops = description.stops
    most = stops.upper - stops.lower if stops else FULL_TURN
    origin = "a sensor that shows the truth"
    return {
        "sensor_scale": _Parameter(nominal=1.0, minimum=0.01, maximum=100.0, origin=origin),
        "sensor_offset": _Parameter(nominal=0.0, minimum=-most, maximum=most, origin=origin),
    }


def _actuator(description: _Description) -> Actuator:
    given = {**_sensor_parameters(description), **description.parameters}
    parameters = {name: _parameter(name, p, description.sensor) for name, p in given.items()}
    stops, winding = description.stops, description.winding
    return Actuator(
        printable(description.name),
        printable(description.title or description.name),
        description.load,
        description.sensor,
        parameters,
        stops.lower if stops else -math.inf,
        stops.upper if stops else math.inf,
        description.effects,
        description.drive,
        description.motion,
        printable(description.joint),
        Winding(winding.rated_current, winding.time_constant, printable(winding.origin)) if winding else None,
    )
