"""Reads a model file (YAML) and names the line of whatever cannot be used."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.actuators import SHIPPED, Actuator, actuator_of, read_actuator
from pierburg_ros.actuators.values import check
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError, near
from pierburg_ros.intake import check_magnitude, path_of, read_yaml, reading
from pierburg_ros.plant.model import Model

SECTIONS = ("actuator", "parameters", "effects", "residual_torque")
FORM = "a model file (YAML)"


def read_model(source: str | Path | Mapping[str, Any], actuator: Actuator | None = None) -> Model:
    """The model in `source`, a path or the content of a model file, of `actuator` where given."""
    if isinstance(source, Mapping):
        return _model(dict(source), actuator, "model", lambda *_: "", Path())
    path = path_of(source, "a model, or the path of its file")
    with reading(path, FORM):
        document = read_yaml(path, FORM)
        if not isinstance(document.content, dict):
            raise InputError(f"{path.name} holds no model; expected {', '.join(SECTIONS)}.")
        return _model(document.content, actuator, path.name, document.line, path.parent)


def _model(content: dict[str, Any], actuator: Actuator | None, label: str, line: Any, folder: Path) -> Model:
    for key in content:
        if key not in SECTIONS:
            raise InputError(f"{label}{line(key)}: unknown {key}; expected {', '.join(SECTIONS)}.{near(key, SECTIONS)}")
    if actuator is None:
        if "actuator" not in content:
            raise InputError(f"{label} names no actuator; expected for example `actuator: pierburg`.")
        actuator = _actuator(content["actuator"], f"{label}{line('actuator')}", folder)
    model = Model.nominal(actuator)
    changes: dict[str, float] = {}
    for name, value in _section(content, "parameters", label, line).items():
        _try(model, {name: value}, f"{label}{line('parameters', name)}", base_only=True)
        changes[name] = value
    for effect, numbers in _section(content, "effects", label, line).items():
        changes.update(_effect(model, effect, numbers, label, line))
    try:
        return model.with_values(changes).with_residual(_residual(content))
    except InputError as error:
        raise InputError(f"{label}: {error}") from None


def _actuator(given: object, place: str, folder: Path) -> Actuator:
    """The actuator of a model file in a `folder`: a shipped name, the path of a description, or the description."""
    if isinstance(given, dict):
        return actuator_of(given, f"{place}: actuator")
    if not isinstance(given, str):
        raise InputError(
            f"{place}: actuator is {given!r:.60}; expected a name like `pierburg`, a path or a description."
        )
    beside = folder / given
    if given in SHIPPED or not beside.exists():
        try:
            return read_actuator(given)
        except InputError as error:
            raise InputError(f"{place}: {error}") from None
    return read_actuator(beside)


def _residual(content: dict[str, Any]) -> dict[str, Any] | None:
    """The residual torque as arrays of numbers, each within the magnitudes of an input."""
    given = content.get("residual_torque")
    if given is None:
        return None
    if not isinstance(given, dict):
        raise InputError(f"residual_torque is {given!r}; expected angle, velocity and torque.")
    for name, values in given.items():
        try:
            array = np.array(values, dtype=float) if _only_numbers(values) else None
        except ValueError:
            array = None
        if array is None:
            raise InputError(f"residual_torque.{name} is not made of numbers; expected lists of equal length.")
        check_magnitude(f"residual_torque.{name}", array.ravel())
    return given


def _only_numbers(values: Any) -> bool:
    """Whether lists hold nothing but numbers and lists of them."""
    if isinstance(values, (list, tuple, np.ndarray)):
        return all(_only_numbers(each) for each in values)
    return isinstance(values, (int, float, np.number)) and not isinstance(values, bool)


def _section(content: dict[str, Any], key: str, label: str, line: Any) -> dict[str, Any]:
    section = content.get(key) or {}
    if not isinstance(section, dict):
        raise InputError(f"{label}{line(key)}: {key} is {section!r}; expected names with values.")
    return section


def _effect(model: Model, effect: str, numbers: Any, label: str, line: Any) -> dict[str, float]:
    place = f"{label}{line('effects', effect)}"
    if effect not in EFFECT:
        raise InputError(
            f"{place}: unknown effect {effect}; expected one of {', '.join(EFFECT)}.{near(effect, EFFECT)}"
        )
    if not isinstance(numbers, dict):
        raise InputError(f"{place}: {effect} is {numbers!r}; expected its parameters with values.")
    declared = EFFECT[effect]
    changes: dict[str, float] = {}
    for name, value in numbers.items():
        if name not in declared.names:
            expected = ", ".join(declared.names)
            raise InputError(
                f"{place}: {effect} has no parameter {name}; expected {expected}.{near(name, declared.names)}"
            )
        _try(model, {f"{effect}.{name}": value}, f"{label}{line('effects', effect, name)}")
        changes[f"{effect}.{name}"] = value
    if any(changes.get(f"{effect}.{name}", 0.0) != 0.0 for name in declared.strength):
        for parameter in declared.parameters:
            if parameter.name not in numbers and parameter.default is None:
                unit = model.actuator.unit_of(f"{effect}.{parameter.name}")
                raise InputError(f"{place}: {effect} lacks {parameter.name} [{unit}]; give a value.")
    return changes


def _try(model: Model, change: dict[str, Any], place: str, base_only: bool = False) -> None:
    name = next(iter(change))
    try:
        if base_only and "." in str(name):
            raise InputError(f"{name} belongs under effects.")
        check(model.actuator, name, change[name])
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
