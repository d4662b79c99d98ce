"""The largest size that the recordings allow an effect that is not named, beside its typical size."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from pierburg_ros.diagnosis.schema import RuledOut
from pierburg_ros.effects import EFFECT
from pierburg_ros.pages.numbers import unit, words
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Bar:
    """An effect, the limit of its strength in words, and that limit as a share of a typical strength."""

    name: str
    text: str
    share: float


def bars(ruled_out: Sequence[RuledOut], model: Model) -> list[Bar]:
    """The limits of all effects that are ruled out, the most excluded first; `model` is the final model."""
    found, several = [], Counter(item.id for item in ruled_out)
    for item in ruled_out:
        effect = EFFECT[item.id]
        name = words(f"{item.id}.{item.parameter}" if several[item.id] > 1 else item.id)
        base = effect.parameter(item.parameter).above
        start = model.values[base] if base is not None else 0.0
        typical = effect.typical_values(model.values, model.scales)[f"{item.id}.{item.parameter}"] - start
        if item.above is not None and item.above > 0.0 and typical > 0.0:
            text = f"above {item.above:.3g}{unit(item.unit)}"
            found.append(Bar(name, text, typical / item.above))
        elif item.below is not None and item.below > start and typical > 0.0:
            text = f"below {item.below:.3g}{unit(item.unit)}"
            found.append(Bar(name, text, (item.below - start) / typical))
    return sorted(found, key=lambda bar: bar.share)
