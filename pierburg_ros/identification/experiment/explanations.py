"""Explanations as the user names them: an effect's id, `nominal`, or a model file."""

from __future__ import annotations

from pathlib import Path

from pierburg_ros.effects import DECLARED, EFFECT
from pierburg_ros.errors import InputError, near
from pierburg_ros.identification.identify import free_names
from pierburg_ros.plant import Model, read_model

NOMINAL = "nominal"
DATES = frozenset(name for name, parameter in DECLARED.items() if parameter.dated)
"""Parameters that give the time of an event in one recording, not a property of the actuator."""


def explanation(name: str, base: Model) -> Model:
    """The model that `name` means: `base`, `base` with an effect of typical size, or a model file."""
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
    """The parameters that an explanation may adapt when it is fitted to another one's response."""
    return tuple(name for name in free_names(model) if name not in DATES)
