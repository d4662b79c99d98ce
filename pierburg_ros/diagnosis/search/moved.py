"""How far each quantity of an explanation moves the signal, beside what remains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data, all_training
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Quantity, Variant, quantities, without
from pierburg_ros.plant import Model


def moved(data: Data, nominal: Model, fit: Fit) -> dict[Quantity, float]:
    """Share of the mean square, of what a quantity moves and of what remains, that it moves: 0 to 1.

    To first order, what drifting parameters can do instead is taken out. Of what it moves: what those of the
    explanation can do, and for an effect one more, whichever does most. Of what remains: what all that may drift can do
    together, where that helps, for it may bend for what no effect makes. On samples that train or on those that
    validate, whichever is less.
    """
    every, own = Estimator(all_training(data), nominal), fit.explanation
    drifts = tuple(dict.fromkeys((*own.drifted, *drifting(nominal))))
    larger = every.at(Explanation(drifts, own.variants), fit.values)
    columns = dict(zip(larger.explanation.names, larger.solution.jacobian.T, strict=True))
    remains = data.residual(fit.model, fit.switch)
    rest = np.minimum(_left(data, remains, []), _left(data, remains, [columns[name] for name in drifts]))

    def share(quantity: Quantity) -> float:
        others = without(own, quantity)
        try:
            lacking = every.models(others, {name: fit.values[name] for name in others.names})
        except InputError:
            return 0.0
        moves = data.residual(*lacking) - remains
        beside = [name for name in own.drifted if name != quantity]
        more = [name for name in drifts if name not in own.drifted] if isinstance(quantity, Variant) else []
        ways = ([columns[name] for name in (*beside, *also)] for also in [(), *((name,) for name in more)])
        least = np.min([_left(data, moves, way) for way in ways], axis=0)
        return float(np.min(least / np.maximum(least + rest, 1e-300)))

    return {quantity: share(quantity) for quantity in quantities(own)}


def _left(data: Data, signal: Signal, columns: Sequence[Signal]) -> Signal:
    """Mean squares of a signal on the samples that train and, if any, on those that validate.

    The `columns` are taken out of it as the samples that train have it.
    """
    if columns:
        known = np.stack(columns, axis=1)
        signal = signal - known @ np.linalg.lstsq(known[data.train], signal[data.train], rcond=None)[0]
    seen = [each for each in (data.train, data.validation) if np.any(each)]
    return np.array([np.mean(np.square(signal[each])) for each in seen])
