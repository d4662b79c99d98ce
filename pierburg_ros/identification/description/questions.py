"""What to ask a person who describes an actuator, and the description that the answers make."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.actuators.description import needed_parameters
from pierburg_ros.actuators.units import unit_of
from pierburg_ros.errors import InputError

RANGE = 10.0
"""Factor by which a number may be off, either way, where nothing says more. Chosen: wider than any drift."""
FIXED = ("gear_ratio", "gravity_torque", "hall_voltage_closed", "hall_voltage_open")
"""Numbers that are known better than recordings tell them."""


@dataclass(frozen=True)
class Question:
    """One thing to ask: which key it answers, in what words, what may be answered, and what an empty answer means."""

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

Ask = Callable[[Question], str]


def answered(ask: Ask) -> dict[str, Any]:
    """The content of a description, from the answers to questions; InputError where one cannot be used."""
    content: dict[str, Any] = {question.key: _checked(question, ask(question)) for question in KINDS}
    stops = content.pop("stops")
    if stops:
        content["stops"] = _stops(stops)
    parameters = {}
    for name in needed_parameters(content["drive"], content["load"], content["sensor"]):
        unit, meaning = UNITS[name]
        shown = unit_of(unit, content["motion"])
        nominal = number(name, ask(Question(name, f"{name} [{shown}], {meaning}")))
        origin = ask(Question(f"{name}.origin", "  where that number comes from", (), "guess"))
        parameters[name] = declared(name, nominal, origin)
    return {**content, "parameters": parameters}


def declared(name: str, nominal: float, origin: str) -> dict[str, Any]:
    """The entry of a parameter with a range about its `nominal` value."""
    size = RANGE * abs(nominal) or RANGE
    low = nominal / RANGE if nominal > 0.0 else -size
    if name in ("spring_stiffness", "coulomb_friction", "supply_voltage", "gravity_torque", "spring_preload"):
        low = min(nominal, 0.0)
    entry: dict[str, Any] = {"nominal": nominal, "minimum": low, "maximum": size, "origin": origin}
    return entry | ({"free": False} if name in FIXED else {})


def number(name: str, text: str) -> float:
    """The number in an answer; InputError where it holds none."""
    try:
        return float(text.replace(",", "."))
    except ValueError:
        raise InputError(f"{name}: found {text!r}, expected a number. Ask its data sheet, or guess.") from None


def _checked(question: Question, answer: str) -> str:
    if question.choices and answer not in question.choices:
        raise InputError(f"{question.key}: found {answer!r}, expected one of {', '.join(question.choices)}.")
    return answer


def _stops(answer: str) -> Mapping[str, float]:
    ends = answer.replace(",", " ").split()
    if len(ends) != 2:
        raise InputError(f"stops: found {answer!r}, expected two numbers, the lower and the upper stop.")
    return {"lower": number("stops", ends[0]), "upper": number("stops", ends[1])}
