"""An actuator description as a file for people: one parameter a line, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import yaml

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.actuators.description import actuator_of
from pierburg_ros.actuators.units import unit_of

FIRST = ("name", "title", "drive", "load", "sensor", "motion", "joint")


def description_text(content: Mapping[str, Any], label: str) -> str:
    """The YAML of a description; InputError, with the `label`, where its content describes no actuator."""
    actuator_of(dict(content), label)
    lines = [f"{key}: {_inline(content[key])}" for key in FIRST if content.get(key)]
    lines += [f"{key}: {_inline(content[key])}" for key in ("stops", "winding") if content.get(key)]
    lines.append("parameters:")
    for name, given in content["parameters"].items():
        unit, meaning = UNITS[name]
        lines.append(f"  {name}: {_inline(given)}  # {unit_of(unit, content.get('motion', 'rotary'))}, {meaning}")
    if content.get("effects"):
        lines.append("effects:")
        lines += [f"  {effect}: {_inline(values)}" for effect, values in content["effects"].items()]
    return "\n".join(lines) + "\n"


def _inline(value: Any) -> str:
    """`value` as YAML on one line."""
    text = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10_000, allow_unicode=True)
    return text.removesuffix("\n").removesuffix("\n...")
