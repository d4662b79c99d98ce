"""What may be the case: which parameters may drift, how a catalogue effect may act, and where its search starts."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.diagnosis.evidence.data import EvidenceData
from pierburg_ros.diagnosis.evidence.missing_torque import missing_torque
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.effects import EFFECTS
from pierburg_ros.effects.effect import Start
from pierburg_ros.effects.effect import Variant as Declared
from pierburg_ros.plant import Model

VARIANTS: dict[Variant, Declared] = {
    Variant(each.id, declared.free, tuple(declared.fixed.items())): declared
    for each in EFFECTS
    for declared in each.variants
}
"""The declaration of each way in which an effect may act."""
STARTS: dict[Variant, Sequence[Start]] = {
    variant: declared.starts for variant, declared in VARIANTS.items() if not callable(declared.starts)
}
"""Starting values that are the same for every recording.

Steps of the converter are not searched for but seen, see `resolution.py`."""
ROUGH = frozenset(each.id for each in EFFECTS if each.jumps)
"""Effects whose cost has many local minima, since events jump with their parameters."""
TIMED = frozenset(each.id for each in EFFECTS if each.dated or each.memory == "lasting")
"""Effects that go by the time since the start: the first part of a recording may not show them."""


def drifting(nominal: Model) -> tuple[str, ...]:
    """Names of what may drift: the free base parameters, and the parameters of effects the actuator always has."""
    own = tuple(f"{effect}.{name}" for effect, values in nominal.actuator.effects.items() for name in values)
    return nominal.actuator.free + own


def is_rough(explanation: Explanation) -> bool:
    """Whether the cost of an explanation has many local minima."""
    return not ROUGH.isdisjoint(explanation.effects)


def starts_of(data: EvidenceData, model: Model) -> dict[Variant, Sequence[Start]]:
    """Starting values by variant on top of `model`: first what starts alike everywhere, then what is read from the
    torque that `model` misses, each in the order of the signal path."""
    missing = missing_torque(data, data.runs[0], model)
    read = {variant: declared.starts(missing) for variant, declared in VARIANTS.items() if callable(declared.starts)}
    return {**STARTS, **read}
