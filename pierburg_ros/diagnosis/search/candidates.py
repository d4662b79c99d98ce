"""What is possible: which parameters may drift, how an effect may act, and where a search for it starts."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from pierburg_ros.actuators import Actuator
from pierburg_ros.diagnosis.evidence.missing_torque import missing_torque
from pierburg_ros.effects import EFFECTS, Effect
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant, canonical
from pierburg_ros.plant import Model

Addition = str | Variant
"""The quantity by which an explanation grows: a parameter (drifted or changed), or an effect."""


def drifting(nominal: Model) -> tuple[str, ...]:
    """Names of the parameters that may drift: free base parameters, and those of effects the actuator always has."""
    own = tuple(f"{effect}.{name}" for effect, values in nominal.actuator.effects.items() for name in values)
    return nominal.actuator.free + own


def possible(actuator: Actuator) -> tuple[Effect, ...]:
    """The effects that can act in an actuator and that the search looks for."""
    return tuple(effect for effect in EFFECTS if effect.variants and not actuator.obstacle(effect))


def starts_of(data: Data, model: Model) -> dict[Variant, list[Start]]:
    """Starting values by variant, to be added to `model`; some are read from the torque that `model` lacks."""
    missing = missing_torque(data, data.longest, model)
    found: dict[Variant, list[Start]] = {}
    for effect in possible(data.actuator):
        for variant in effect.variants:
            starts = variant.starts(missing) if callable(variant.starts) else variant.starts
            fixed = effect.in_units(variant.fixed, model.scales)
            found[Variant(effect.id, variant.free, tuple(fixed.items()))] = [
                effect.in_units(start, model.scales) for start in starts
            ]
    return found


def may_change(explanation: Explanation, data: Data) -> bool:
    """Whether a change in mid-recording may be added to an explanation: only without effects and in a single run."""
    return not explanation.variants and explanation.changed is None and len(data.runs) == 1


def with_drifts(explanation: Explanation, drifts: tuple[str, ...], count: int) -> Iterator[Explanation]:
    """The explanation with `count` more drifting parameters, for each combination of those that do not drift yet."""
    free = [name for name in drifts if name not in explanation.drifted and name != explanation.changed]
    for others in itertools.combinations(free, count):
        key = canonical(Explanation((*explanation.drifted, *others), explanation.variants, explanation.changed), drifts)
        if key is not None:
            yield key


def expansions(base: Fit, data: Data, drifts: tuple[str, ...]) -> dict[Explanation, tuple[Addition, list[Start]]]:
    """Every explanation with one quantity more than `base`: the addition, and where its search may start."""
    seed = base.explanation
    additions: list[tuple[Explanation, Addition, list[Start]]] = []
    for name in drifts:
        additions.append((Explanation((*seed.drifted, name), seed.variants, seed.changed), name, [base.values]))
        if may_change(seed, data):
            additions.append((Explanation(seed.drifted, seed.variants, name), name, []))
    for variant, starts in starts_of(data, base.model).items():
        additions.append((seed.plus(variant), variant, starts))
    found: dict[Explanation, tuple[Addition, list[Start]]] = {}
    for explanation, addition, starts in additions:
        key = canonical(explanation, drifts)
        if key is not None:
            found.setdefault(key, (addition, starts))
    return found
