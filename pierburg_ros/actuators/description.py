"""Reads an actuator description (YAML), shipped or a user's own, and says clearly what is wrong with it."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from pierburg_ros.actuators.actuator import UNITS, Actuator, Load, NominalParameter, Quantity
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.intake import parsed, reading, text_of

SHIPPED = ("pierburg", "xl330")
"""Actuators that come with the package."""

_COMMON = {
    "armature_resistance",
    "torque_constant",
    "gear_ratio",
    "coulomb_friction",
    "total_inertia",
    "supply_voltage",
}
_NEEDED = {"spring": {"spring_stiffness", "spring_preload"}, "pendulum": {"gravity_torque"}}
_SENSOR = {"hall_voltage": {"hall_voltage_closed", "hall_voltage_open"}, "position": set[str]()}


FORM = "an actuator description (YAML)"


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, strict=True)


class _Parameter(_Strict):
    nominal: float
    minimum: float
    maximum: float
    origin: str = Field(min_length=1)
    free: bool = True

    @model_validator(mode="after")
    def _in_range(self) -> _Parameter:
        if not self.minimum <= self.nominal <= self.maximum:
            raise ValueError(f"nominal {self.nominal} is outside its range {self.minimum} to {self.maximum}")
        return self


class _Stops(_Strict):
    lower: float
    upper: float


class _Description(_Strict):
    name: str = Field(min_length=1)
    title: str = ""
    load: Load
    sensor: Quantity
    stops: _Stops | None = None
    parameters: dict[str, _Parameter]
    effects: dict[str, dict[str, float]] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _complete(self) -> _Description:
        needed = _COMMON | _NEEDED[self.load] | _SENSOR[self.sensor]
        if missing := sorted(needed - set(self.parameters)):
            raise ValueError(f"parameters lacks {', '.join(missing)}, needed with load {self.load}")
        if unknown := sorted(set(self.parameters) - set(UNITS)):
            raise ValueError(f"parameters has unknown {', '.join(unknown)}; known: {', '.join(UNITS)}")
        if self.stops and self.stops.lower >= self.stops.upper:
            raise ValueError("stops.lower must be less than stops.upper")
        for effect, values in self.effects.items():
            if effect not in EFFECT:
                raise ValueError(f"effects has unknown {effect}; known: {', '.join(EFFECT)}")
            if unknown := sorted(set(values) - set(EFFECT[effect].names)):
                raise ValueError(f"{effect} has no parameter {', '.join(unknown)}")
        return self


def read_actuator(source: str | Path) -> Actuator:
    """The actuator called `source` (a shipped name, or the path of a YAML file); InputError where unusable."""
    with reading(source, FORM):
        text, label = _text(source)
        content = parsed(text, label, FORM).content
        if not isinstance(content, dict):
            raise InputError(f"{label} holds no actuator description; expected name, load, sensor, parameters.")
        try:
            return _actuator(_Description.model_validate(content))
        except ValidationError as error:
            problem = _first_problem(error)
            raise InputError(f"{label}: {problem}. Compare it with examples/my_actuator.yaml.") from None


def _text(source: str | Path) -> tuple[str, str]:
    if str(source) in SHIPPED:
        file = resources.files("pierburg_ros.actuators") / f"{source}.yaml"
        return file.read_text(encoding="utf-8"), f"actuator {source}"
    path = Path(source)
    if not path.exists():
        raise InputError(
            f"There is no actuator {source}; expected {' or '.join(SHIPPED)} or the path of a YAML description."
        )
    return text_of(path, FORM), path.name


def _first_problem(error: ValidationError) -> str:
    problem: Any = error.errors()[0]
    place = ".".join(str(part) for part in problem["loc"])
    message = problem["msg"].removeprefix("Value error, ")
    return f"{place}: {message}" if place else message


def _parameter(name: str, given: _Parameter) -> NominalParameter:
    unit, meaning = UNITS[name]
    return NominalParameter(
        name, given.nominal, meaning, unit, given.minimum, given.maximum, origin=given.origin, free=given.free
    )


def _actuator(description: _Description) -> Actuator:
    parameters = {name: _parameter(name, p) for name, p in description.parameters.items()}
    stops = description.stops
    return Actuator(
        description.name,
        description.title or description.name,
        description.load,
        description.sensor,
        parameters,
        stops.lower if stops else -math.inf,
        stops.upper if stops else math.inf,
        description.effects,
    )
