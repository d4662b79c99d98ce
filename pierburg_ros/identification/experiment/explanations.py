"""Explanations as a person names them: an effect's id, `nominal`, or a model file."""

from __future__ import annotations

from pathlib import Path

from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Parameter
from pierburg_ros.errors import InputError
from pierburg_ros.identification.identify import free_names
from pierburg_ros.plant import Model

NOMINAL = "nominal"
TIMING = ("external_load.start", "external_load.end", "external_load.phase")
"""Parameters that say when something happened in one recording, not what the actuator is."""


def explanation(name: str, base: Model, duration: float) -> Model:
    """The model that `name` means: `base`, `base` with an effect at a plausible strength, or a model file.

    A load that an effect puts on for a time acts for the `duration` [s] of the experiment.
    """
    if name == NOMINAL:
        return base
    if name in EFFECT:
        return base.with_values(typical_values(name, duration))
    if Path(name).is_file():
        return Model.read(name)
    raise InputError(
        f"{name} is neither an effect nor a model file; expected {NOMINAL}, a path, or one of {', '.join(EFFECT)}."
    )


def typical_values(effect: str, duration: float) -> dict[str, float]:
    """Values of an effect in the middle of its plausible ranges; of several strengths the first alone."""
    declared = EFFECT[effect]
    values = {}
    for parameter in declared.parameters:
        name = f"{effect}.{parameter.name}"
        if parameter.name in declared.strength[1:] or name in TIMING:
            values[name] = 0.0
        else:
            values[name] = _middle(parameter)
    if effect == "external_load":
        values["external_load.end"] = duration
    if effect == "nonlinear_spring":
        values["nonlinear_spring.knee_angle"] = 0.0
    return values


def refitted_names(model: Model) -> tuple[str, ...]:
    """What an explanation may adapt when it is fitted to another one's answer."""
    return tuple(name for name in free_names(model) if name not in TIMING)


def _middle(parameter: Parameter) -> float:
    if parameter.choices:
        return parameter.choices[0]
    low, high = parameter.plausible
    return 0.5 * high if low < 0.0 else 0.5 * (low + high)
