"""An effect that repeats with every turn of a shaft, named by the balance of torques."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.diagnosis.remainder.left_out import BETTER, LeftOut
from pierburg_ros.diagnosis.search.candidates import drifting, possible
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.weighing import Supported, Weight
from pierburg_ros.effects import Effect
from pierburg_ros.estimation.data import Data, all_training
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.torque_balance import Balance
from pierburg_ros.estimation.turn import left_of_torque, repeated, with_lesser_orders
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class _Around:
    """The strongest order as an effect, fitted with drifts to a nominal model that has the `lesser` orders."""

    lesser: Model
    fit: Fit
    variant: Variant
    balance: Balance


def goes_around(data: Data, nominal: Model) -> bool:
    """Whether a torque over a turn has overtones, and validation samples confirm them.

    The unexplained torque must be smaller by a tenth there. A simulation shows less: a slow rotor is simulated in
    stretches, and their fitted initial states compensate for the torque.
    """
    unseen = replace(data, runs=tuple(run.trained_on(run.validation) for run in data.runs))
    left = left_of_torque(data, unseen, nominal)
    return left is not None and left[1] < BETTER * left[0]


def supported_around(data: Data, nominal: Model) -> Supported | None:
    """The strongest order of a torque over a turn as an effect, beside drifts; None where `goes_around` does not hold.

    None also where the nominal model has such an effect already: what it lacks becomes part of the torque over a turn.

    By chance an order stands out so far once in a hundred recordings. Its weight is its share of the mean square of the
    torque, beside the part that no order explains. Without overtones a search finds it like any other effect.
    """
    effect = _over_the_angle(nominal)
    around = _around(data, nominal, effect) if effect and goes_around(data, nominal) else None
    if around is None:
        return None
    amplitude = math.hypot(*around.balance.strongest[:2])
    samples = int(np.count_nonzero(data.train))
    weight = Weight(samples * 0.5 * (amplitude / around.balance.left) ** 2, float(samples))
    return Supported(around.lesser, scored(data, around.fit), {around.variant: weight})


def vouched_around(data: Data, nominal: Model) -> LeftOut | None:
    """How much recordings left out support that effect when it is fitted to the others; None where they do not support
    it.

    The unexplained torque on recordings left out must fall as far as that on validation samples.
    """
    every = all_training(data)
    names = {run.number: run.name for run in data.runs}
    left = [left_of_torque(every.without(number), every.only(number), nominal) for number in names]
    if None in left:
        return None
    without, beside = np.array(left, dtype=float).T
    helped = tuple(name for name, better in zip(names.values(), beside < without, strict=True) if better)
    before, after = (float(np.exp(np.mean(np.log(each)))) for each in (without, beside))
    return LeftOut(before, after, len(helped), len(names), helped, "N.m") if after <= BETTER * before else None


def _around(data: Data, nominal: Model, effect: Effect) -> _Around | None:
    found = repeated(data, nominal)
    if found is None or found.orders.size < 2:
        return None
    ripple = effect.ripple
    assert ripple is not None
    cosine, sine, order = found.strongest
    values = {
        "coulomb_friction": found.friction,
        f"{effect.id}.{ripple.amplitude}": math.hypot(cosine, sine),
        f"{effect.id}.{ripple.rhythm}": order / nominal.values.get("gear_ratio", 1.0),
        f"{effect.id}.{ripple.phase}": math.atan2(cosine, sine),
    }
    variant = Variant(effect.id, (ripple.amplitude, ripple.rhythm, ripple.phase))
    lesser = with_lesser_orders(data, nominal)
    explanation = Explanation(drifting(nominal), (variant,))
    held = f"{effect.id}.{ripple.rhythm}"
    start = {**nominal.values, **values}
    # where the shaft is caught in motion, errors are large and say little
    fit = Estimator(data, lesser).fit(explanation, start, BRIEF, held=held, forgiving=True)
    return _Around(lesser, fit, variant, found)


def _over_the_angle(nominal: Model) -> Effect | None:
    """The effect that is a sine over the angle; None where `nominal` has it already, since it has one order alone."""
    sines = (each for each in possible(nominal.actuator) if each.ripple is not None and each.turns_within is not None)
    effect = next(sines, None)
    return None if effect is None or effect.acts(nominal.values) else effect
