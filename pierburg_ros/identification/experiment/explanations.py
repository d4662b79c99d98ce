"""Explanations as a person names them: an effect's id, `nominal`, or a model file."""

from __future__ import annotations

from pathlib import Path

from pierburg_ros.effects import DECLARED, EFFECT
from pierburg_ros.errors import InputError, near
from pierburg_ros.identification.identify import free_names
from pierburg_ros.plant import Model, read_model

NOMINAL = "nominal"
DATES = frozenset(name for name, parameter in DECLARED.items() if parameter.dated)
"""Parameters that say when something happened in one recording, not what the actuator is."""


def explanation(name: str, base: Model) -> Model:
    """The model that `name` means: `base`, `base` with an effect as one meets it, or a model file."""
    if name == NOMINAL:
        return base
    if name in EFFECT:
        return base.with_values(EFFECT[name].typical_values(base.values, base.scales))
    if Path(name).is_file():
        return read_model(name)
    raise InputError(
        f"{name} is neither an effect nor a model file; expected {NOMINAL}, a path, or one of {', '.join(EFFECT)}."
        f"{near(name, [NOMINAL, *EFFECT])}"
    )


def refitted_names(model: Model) -> tuple[str, ...]:
    """What an explanation may adapt when it is fitted to another one's answer."""
    return tuple(name for name in free_names(model) if name not in DATES)
