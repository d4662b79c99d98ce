"""What can be said where no explanation accounts for all."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.remainder.around import supported_around, vouched_around
from pierburg_ros.diagnosis.remainder.confirmed import confirmed
from pierburg_ros.diagnosis.remainder.left_out import BETTER, LeftOut
from pierburg_ros.diagnosis.remainder.recalibrations import recalibrations
from pierburg_ros.diagnosis.remainder.shape import Shape, fit_shape
from pierburg_ros.diagnosis.remainder.shared import shared_effects
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.supported import Supported, Weight, likelier, supported, told_apart, with_play
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant
from pierburg_ros.estimation.intervals import Estimate, estimates
from pierburg_ros.workers import workers

SHARED = 0.6
"""Share of the time that is left in which effects are added that several recordings share. Work: the rest is for
intervals and for the shape of what remains; not varied."""


@dataclass(frozen=True)
class Remainder:
    """The model that the rest stands on, with the intervals of its values by dotted name.

    Beside it why each of its effects is believed, by id: by what recordings left out say, or by its weight beside what
    remains; and the rest as a torque over angle and velocity, None where unseen data do not confirm one.
    """

    base: Fit
    estimates: dict[str, Estimate]
    left_out: Mapping[str, LeftOut]
    weights: Mapping[str, Weight]
    shape: Shape | None


def unexamined(found: Found) -> Remainder:
    """What stands where there is no time to look at what remains: the model below it, and no effect."""
    return Remainder(found.estimator.restated(_below(found, None)), {}, {}, {}, None)


def unnamed(found: Found, jobs: int | None, deadline: Deadline) -> Remainder:
    """What stands where no effect can be concluded: the model below what remains, with intervals."""
    base = found.estimator.restated(_below(found, None))
    with workers(jobs, deadline) as pool:
        return Remainder(base, estimates(found.estimator, base, pool.map), {}, {}, None)


def remainder(
    found: Found, progress: Progress = lambda _: None, jobs: int | None = None, deadline: Deadline | None = None
) -> Remainder:
    """Physics beyond one explanation, and the shape of what is left.

    What repeats itself with every turn comes first. Else several recordings vouch for effects that each lower the error
    on recordings left out, a single one for quantities that unseen samples confirm when the evidence is counted against
    what remains. What is then left is fitted as a torque over angle and velocity, kept where unseen data confirm it.
    """
    data, estimator, recalibrated = found.data, found.estimator, found.recalibrated
    weights: Mapping[str, Weight] = {}
    base: Fit | None = None
    deadline = deadline or Deadline()
    around = supported_around(data, found.nominal)
    vouched = vouched_around(data, found.nominal) if around and data.several else None
    searched = data.several and vouched is None
    shared = shared_effects(found, progress, jobs, deadline.part(SHARED)) if searched else None
    with workers(jobs, deadline) as pool:
        if shared is not None:
            fit, left_out = shared
            base = named = estimator.restated(fit)
            shape = fit_shape(data, [lambda _: named.model], pool, progress)
        elif stood := around or _stood(found, pool, progress):
            left_out, weights = {}, _by_effect(stood)
            if vouched is not None:
                left_out, weights = dict.fromkeys(weights, vouched), {}
            estimator = Estimator(data, stood.nominal, discrepancy=stood.scored.discrepancy)
            base = named = estimator.restated(stood.scored.fit)
            shape = fit_shape(data, [lambda _: named.model], pool, progress)
        else:
            left_out = {}
            shape = fit_shape(data, recalibrations(found.nominal, recalibrated.explanation), pool, progress)
        stands = confirmed(shape, data, pool)
        base = base or _below(found, shape if stands else None)
        known = estimates(estimator, base, pool.map)
    return Remainder(found.estimator.restated(base), known, left_out, weights, shape if stands else None)


def _below(found: Found, shape: Shape | None) -> Fit:
    """The model without an effect: what the `shape` that stands was fitted to, else the recalibrated one.

    The nominal model, where samples that validate do not improve by a tenth: numbers that only bend have not drifted.
    """
    recalibrated, nominal = found.recalibrated, found.fits[Explanation()]
    if shape is None:
        misfit = found.estimator.validation_misfit
        return recalibrated if misfit(recalibrated) < BETTER**2 * misfit(nominal) else nominal
    names = recalibrated.explanation.names
    changed = any(shape.base.values[name] != found.nominal.values[name] for name in names)
    return found.estimator.at(recalibrated.explanation if changed else Explanation(), shape.base.values)


def _stood(found: Found, pool: Executor, progress: Progress) -> Supported | None:
    """What unseen samples of a single recording confirm and nothing simpler stands for, and the play of its sensor.

    A play is read from the samples themselves: it needs none of the others.
    """
    data, nominal = found.data, found.nominal
    nearest = min((fit for fit in found.fits.values() if fit.explanation.changed is None), key=lambda fit: fit.chi2)
    added = found.beside or supported(data, nominal, pool, progress)
    beside = likelier(added, nearest, data, nominal, pool)
    named = told_apart(beside.confirmed, data, nominal, pool, progress)
    if _doubtful(named, found):
        named = Supported(nominal, scored(data, found.estimator.at(Explanation())), {})
    both = with_play(named, beside.reached.fit, data, nominal)
    return both if both.weights else None


def _doubtful(stood: Supported, found: Found) -> bool:
    """Whether the recalibrated model hardly gains by the effects where a simulation begins again and again.

    An error there is no bad luck, and has to fall by a tenth on samples that validate: with the effects alone, or with
    them beside all that was recalibrated. What was read from the samples themselves, without a free number, stands on
    no simulation.
    """
    if not (stood.scored.fit.explanation.names and found.data.in_stretches):
        return False
    estimator, named, known = Estimator(found.data, stood.nominal), stood.scored.fit, found.recalibrated
    most = BETTER**2 * found.estimator.validation_misfit(known)
    if estimator.validation_misfit(named) <= most:
        return False
    both = Explanation(known.explanation.drifted, named.explanation.variants)
    beside = estimator.fit(both, {**named.values, **{name: known.values[name] for name in both.drifted}})
    return estimator.validation_misfit(beside) > most


def _by_effect(stood: Supported) -> dict[str, Weight]:
    """The weight of each effect, by id."""
    return {key.effect: weight for key, weight in stood.weights.items() if isinstance(key, Variant)}
