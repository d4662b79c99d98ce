"""The results that can be reported where no explanation accounts for all."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.remainder.confirmed import confirmed
from pierburg_ros.diagnosis.remainder.left_out import BETTER, LeftOut
from pierburg_ros.diagnosis.remainder.recalibrations import recalibrations
from pierburg_ros.diagnosis.remainder.shape import Shape, fit_shape
from pierburg_ros.diagnosis.remainder.standing import Standing
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.intervals import Estimate, estimates
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.workers import workers


@dataclass(frozen=True)
class Remainder:
    """The model below the remainder, with the intervals of its values by dotted name.

    `left_out` and `weights` say why each of its effects is believed, as in `Standing`. `shape` is the rest as a torque
    over angle and velocity; None where unseen data do not confirm one. `doubted` are the effects that are not probable
    enough to be named.
    """

    base: Fit
    estimates: dict[str, Estimate]
    left_out: Mapping[str, LeftOut]
    weights: Mapping[str, Weight]
    shape: Shape | None
    doubted: Mapping[str, Weight] = field(default_factory=dict)


def unexamined(found: Found, named: Standing | None = None) -> Remainder:
    """The result without time to examine the remainder: the accepted model, else the one below it, without intervals.

    A parameter that adapts to the rest counts as not drifted as long as no interval shows a drift.
    """
    named = named or Standing(found.estimator)
    base = found.estimator.restated(named.base or _below(found, None))
    base = base if named.base else replace(base, explanation=Explanation())
    return Remainder(base, dict(named.told), named.left_out, named.weights, None, named.doubted)


def unnamed(found: Found, jobs: int | None, deadline: Deadline) -> Remainder:
    """The result where no effect can be concluded: the model below the remainder, with intervals."""
    base = found.estimator.restated(_below(found, None))
    with workers(jobs, deadline) as pool:
        return Remainder(base, estimates(found.estimator, base, pool.map), {}, {}, None)


def remainder(
    found: Found,
    named: Standing,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    deadline: Deadline | None = None,
) -> Remainder:
    """The shape of the rest beside the accepted model, and the intervals of that model.

    The shape is fitted as a torque over angle and velocity, and kept where unseen data confirm it.
    """
    data = found.data
    with workers(jobs, deadline) as pool:
        named, known = certain(named, pool)
        model = named.base and named.base.model
        ways = [lambda _: model] if model else recalibrations(found.nominal, found.recalibrated.explanation)
        shape = fit_shape(data, ways, pool, progress)
        stands = confirmed(shape, data, pool)
        base = named.base or _below(found, shape if stands else None)
        known = known if named.base else estimates(named.estimator, base, pool.map)
    base = found.estimator.restated(base)
    return Remainder(base, known, named.left_out, named.weights, shape if stands else None, named.doubted)


def certain(named: Standing, pool: Executor) -> tuple[Standing, dict[str, Estimate]]:
    """The accepted model without effects that may as well not act, and the intervals of its values by dotted name.

    An effect may gain in a single recording, and yet the interval of each of its strengths may contain 0.
    """
    if named.base is None:
        return named, {}
    known = {**estimates(named.estimator, named.base, pool.map), **named.told}
    own = named.base.explanation
    idle = [variant for variant in own.variants if variant.effect in named.weights and not _acts(variant, known)]
    if not idle:
        return named, known
    smaller = Explanation(own.drifted, tuple(each for each in own.variants if each not in idle), own.changed)
    weights = {effect: weight for effect, weight in named.weights.items() if effect in smaller.effects}
    base = named.estimator.fit(smaller, named.base.values) if smaller.size else None
    return certain(replace(named, base=base, weights=weights), pool)


def _acts(variant: Variant, known: Mapping[str, Estimate]) -> bool:
    """Whether the interval of a strength excludes 0, or no interval is known."""
    names = (f"{variant.effect}.{name}" for name in EFFECT[variant.effect].strength)
    intervals = [known[name] for name in names if name in known]
    return not intervals or any(each.low > 0.0 or each.high < 0.0 for each in intervals)


def _below(found: Found, shape: Shape | None) -> Fit:
    """The model without an effect: the one to which an accepted `shape` was fitted, else the recalibrated one.

    It is the nominal model where validation samples do not improve by a tenth: parameters that only adapt have not
    drifted.
    """
    recalibrated, nominal = found.recalibrated, found.fits[Explanation()]
    if shape is None:
        misfit = found.estimator.validation_misfit
        return recalibrated if misfit(recalibrated) < BETTER**2 * misfit(nominal) else nominal
    names = recalibrated.explanation.names
    changed = any(shape.base.values[name] != found.nominal.values[name] for name in names)
    return found.estimator.at(recalibrated.explanation if changed else Explanation(), shape.base.values)
