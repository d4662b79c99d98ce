"""The questions to a person who describes an actuator, and the description that follows from the answers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeVar

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.actuators.description import MAGNITUDES, POSITIVE, needed_parameters
from pierburg_ros.actuators.units import unit_of
from pierburg_ros.errors import InputError

RANGE = 10.0
"""Factor by which a number may be wrong, either way, where nothing says more. Chosen: wider than any drift."""
FIXED = ("gear_ratio", "gravity_torque", "hall_voltage_closed", "hall_voltage_open")
"""Numbers that are known better than recordings determine them."""


@dataclass(frozen=True)
class Question:
    """One question: the key that it answers, its words, the possible answers, and the meaning of an empty answer."""

    key: str
    text: str
    choices: tuple[str, ...] = ()
    default: str | None = None


KINDS = (
    Question("name", "Name of the actuator"),
    Question("drive", "What drives it", ("voltage", "current", "torque"), "voltage"),
    Question("load", "What loads it", ("spring", "pendulum", "none"), "none"),
    Question("sensor", "What its sensor gives", ("hall_voltage", "position", "speed"), "position"),
    Question("motion", "How it moves", ("rotary", "linear"), "rotary"),
    Question("stops", "Its stops, lower and upper [rad, or m], or nothing where there are none", (), ""),
)

Ask = Callable[[Question, str], str]
"""Gives the answer to a question; the text says what was wrong with the last answer, if there was one."""
Used = TypeVar("Used")


def answered(ask: Ask) -> dict[str, Any]:
    """The content of a description, from answers to questions; each question is repeated until its answer is usable."""
    content: dict[str, Any] = {question.key: _used(question, partial(_checked, question), ask) for question in KINDS}
    stops = content.pop("stops")
    if stops:
        content["stops"] = stops
    parameters = {}
    for name in needed_parameters(content["drive"], content["load"], content["sensor"]):
        unit, meaning = UNITS[name]
        question = Question(name, f"{name} [{unit_of(unit, content['motion'])}], {meaning}")
        nominal = _used(question, partial(_nominal, name), ask)
        origin = ask(Question(f"{name}.origin", "  where that number comes from", (), "guess"), "")
        parameters[name] = declared(name, nominal, origin)
    return {**content, "parameters": parameters}


def _used(question: Question, use: Callable[[str], Used], ask: Ask) -> Used:
    """The result of `use` for the first answer that it does not refuse."""
    problem = ""
    while True:
        answer = ask(question, problem)
        try:
            return use(answer)
        except InputError as error:
            problem = str(error)


def declared(name: str, nominal: float, origin: str) -> dict[str, Any]:
    """The entry of a parameter with a range around its `nominal` value."""
    size = RANGE * abs(nominal) or RANGE
    low = nominal / RANGE if nominal > 0.0 else -size
    if name in ("spring_stiffness", "coulomb_friction", "supply_voltage", "gravity_torque", "spring_preload"):
        low = min(nominal, 0.0)
    ends = {"minimum": float(f"{low:.6g}"), "maximum": float(f"{size:.6g}")}
    entry: dict[str, Any] = {"nominal": nominal, **ends, "origin": origin}
    return entry | ({"free": False} if name in FIXED else {})


def number(name: str, text: str) -> float:
    """The number in an answer; InputError where it holds none."""
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{name}: found {text!r}, expected a number alone. Ask its data sheet, or guess.")
    return value


def _nominal(name: str, text: str) -> float:
    """The number of a parameter; InputError where no actuator has it."""
    value = number(name, text)
    if value <= 0.0 and name in POSITIVE | {"supply_voltage"}:
        raise InputError(f"{name}: found {text!r}, expected a number above 0. Ask its data sheet, or guess.")
    if name in MAGNITUDES and value < 0.0:
        raise InputError(f"{name}: found {text!r}, expected 0 or more. Give its magnitude.")
    return value


def _checked(question: Question, answer: str) -> str | Mapping[str, float]:
    if question.choices and answer not in question.choices:
        raise InputError(f"{question.key}: found {answer!r}, expected one of {', '.join(question.choices)}.")
    return _stops(answer) if question.key == "stops" else answer


def _stops(answer: str) -> Mapping[str, float]:
    ends = answer.replace(";", " ").split()
    if not ends:
        return {}
    if len(ends) != 2:
        raise InputError(f"stops: found {answer!r}, expected two numbers, the lower and the upper stop.")
    lower, upper = (number("stops", end.strip(",")) for end in ends)
    if lower >= upper:
        raise InputError(f"stops: found {answer!r}, expected the lower stop first and the upper one above it.")
    return {"lower": lower, "upper": upper}
