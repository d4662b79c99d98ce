"""The plants a controller is tuned and judged on: as built, hot, and with each effect of the catalogue."""

from __future__ import annotations

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS
from pierburg_ros.plant import Model

NOMINAL = "nominal"
HOT = "resistance x 1.42"
STICKY = "static friction"
RESISTANCE = {"resistance x 1.17": 1.17, HOT: 1.42}
"""Factors of the armature resistance in the paper's Fig. 10 and Fig. 11."""


def variations(model: Model) -> dict[str, Model]:
    """A plant as it is, and with its winding hotter, as far as its description allows."""
    name, most = "armature_resistance", model.actuator.parameters["armature_resistance"].maximum
    hot = {label: min(model.values[name] * factor, most) for label, factor in RESISTANCE.items()}
    return {NOMINAL: model, **{label: model.with_values({name: value}) for label, value in hot.items()}}


def plant_set() -> dict[str, Model]:
    """Every plant of the set by name: the nominal one, the hot ones, and one for each effect as one meets it."""
    nominal = Model.nominal(read_actuator("pierburg"))
    resistance = nominal.values["armature_resistance"]
    hot = {name: nominal.with_values({"armature_resistance": resistance * share}) for name, share in RESISTANCE.items()}
    worn = {
        effect.id.replace("_", " "): nominal.with_values(effect.typical_values(nominal.values, nominal.scales))
        for effect in EFFECTS
    }
    return {NOMINAL: nominal, **hot, **worn}
