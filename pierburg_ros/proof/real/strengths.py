"""How strong an effect is put in, and by how much a description is made wrong: from plain to what is ruled out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pierburg_ros.actuators import Actuator
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.plant import Model

LEVELS = ("plain", "between", "limit", "half")
"""Plain; halfway to what the untouched recording is said to rule out, as a ratio; that limit; half of it."""
WRONG = {"plain": 1.3, "half": 1.15}
"""Factors by which a number of the description is told too high. Chosen: two and one of the tolerance of values within
which a right one has to be found, so that the number as told is never right at the plain level; not varied."""


def possible(actuator: Actuator) -> tuple[str, ...]:
    """Ids of the effects that an actuator may have and that can be put into its recordings."""
    return tuple(effect.id for effect in EFFECTS if effect.put_in is not None and not actuator.obstacle(effect))


def tellable(actuator: Actuator) -> tuple[str, ...]:
    """Names of the base parameters that a description may have wrong and a diagnosis corrects, the sensor's aside."""
    return tuple(name for name in actuator.free if "." not in name and not name.startswith("sensor_"))


def strength(effect: str, level: str, model: Model, ruled_out: Sequence[Mapping[str, Any]]) -> float | None:
    """Strength of an effect at a level, in the unit of its first strength parameter.

    Plain is the upper end of what its declaration calls plausible in such an actuator. None where the level does not
    exist: the untouched recording, whose diagnosis says what is `ruled_out`, sets no limit, or none below plain.
    """
    declared = EFFECT[effect].parameter(EFFECT[effect].strength[0])
    plain = declared.expected(model.scales)[1]
    if level == "plain":
        return plain
    own = [item for item in ruled_out if (item["id"], item["parameter"]) == (effect, declared.name)]
    limit = own[0]["below"] if own else None
    if limit is None:
        return plain / 2.0 if level == "half" and EFFECT[effect].rounds else None
    if level == "between":
        return float((plain * limit) ** 0.5) if limit < plain / 2.0 else None
    return float(limit) if level == "limit" else float(limit) / 2.0


def values_at(effect: str, strength: float, model: Model) -> dict[str, float]:
    """All parameters of an effect by name, those beside the strength as they typically are in such an actuator."""
    declared = EFFECT[effect]
    typical = declared.in_units(declared.typical, model.scales)
    return {name: typical.get(name, 0.0) for name in declared.names} | {declared.strength[0]: strength}
