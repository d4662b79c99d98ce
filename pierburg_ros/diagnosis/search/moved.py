"""How far each quantity of an explanation moves the signal, compared with the remainder."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data, all_training
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.explanation import Explanation, Quantity, Variant, quantities, without
from pierburg_ros.plant import Model


def moved(data: Data, nominal: Model, fit: Fit) -> dict[Quantity, float]:
    """Share, 0 to 1, of each quantity in the mean square of its own signal and the remainder together.

    The part that drifting parameters can reproduce is removed, to first order. From the signal of a quantity, this is
    the part that the explanation's own drifts reproduce. For an effect, one more drift is added to them, the one that
    removes most. From the remainder, this is the part that all parameters that may drift reproduce together, where that
    lowers it. These parameters may adapt to an error that no effect makes. The share is the lower one of those on
    training and on validation samples.
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
    """Mean squares of a signal on the training and, if any, on the validation samples, shape (2,) or (1,).

    The `columns` are removed from the signal with weights fitted on the training samples.
    """
    if columns:
        known = np.stack(columns, axis=1)
        signal = signal - known @ np.linalg.lstsq(known[data.train], signal[data.train], rcond=None)[0]
    seen = [each for each in (data.train, data.validation) if np.any(each)]
    return np.array([np.mean(np.square(signal[each])) for each in seen])
