"""An effect that repeats itself with every turn of a shaft, named by the balance of torques."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.diagnosis.remainder.left_out import BETTER
from pierburg_ros.diagnosis.remainder.turn import repeated, with_lesser_orders
from pierburg_ros.diagnosis.search.candidates import drifting, possible
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.supported import Supported, Weight
from pierburg_ros.effects import Effect
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.plant import Model


def supported_around(data: Data, nominal: Model, recalibrated: Fit) -> Supported | None:
    """The strongest order of a torque over a turn as an effect, beside drifts; None where there are no overtones.

    None, too, where that does not better the `recalibrated` model on samples that validate. Chance raises an order so
    far once in a hundred recordings. Its weight is its share of the mean square of the torque, beside what no order
    makes up. Without overtones a search finds it as any other effect.
    """
    found, effect = repeated(data, nominal), _over_the_angle(nominal)
    if found is None or effect is None or found.orders.size < 2:
        return None
    ripple = effect.ripple
    assert ripple is not None
    cosine, sine, order = found.strongest
    amplitude = math.hypot(cosine, sine)
    values = {
        "coulomb_friction": found.friction,
        f"{effect.id}.{ripple.amplitude}": amplitude,
        f"{effect.id}.{ripple.rhythm}": order / nominal.values.get("gear_ratio", 1.0),
        f"{effect.id}.{ripple.phase}": math.atan2(cosine, sine),
    }
    variant = Variant(effect.id, (ripple.amplitude, ripple.rhythm, ripple.phase))
    beside = with_lesser_orders(data, nominal)
    explanation = Explanation(drifting(nominal), (variant,))
    held = f"{effect.id}.{ripple.rhythm}"
    start = {**nominal.values, **values}
    # where the shaft is caught in motion errors are large, and say little
    fit = Estimator(data, beside).fit(explanation, start, BRIEF, held=held, forgiving=True)
    if _error(data, fit) > BETTER * _error(data, recalibrated):
        return None
    samples = int(np.count_nonzero(data.train))
    weight = Weight(samples * 0.5 * (amplitude / found.left) ** 2, float(samples))
    return Supported(beside, scored(data, fit), {variant: weight})


def _over_the_angle(nominal: Model) -> Effect | None:
    """The effect that is a sine over the angle."""
    sines = (each for each in possible(nominal.actuator) if each.ripple is not None and each.turns_within is not None)
    return next(sines, None)


def _error(data: Data, fit: Fit) -> float:
    return rms(data.residual(fit.model, fit.switch)[data.validation])
