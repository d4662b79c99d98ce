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

    What drifting parameters can do instead is taken out of both, to first order: those of the explanation, and for an
    effect one more, whichever does most. On samples that train or on those that validate, whichever is less. From 0.5
    on a blind trial counts an effect as shown beside a remainder (`proof/visibility.py`).
    """
    every, own = Estimator(all_training(data), nominal), fit.explanation
    drifts = tuple(dict.fromkeys((*own.drifted, *drifting(nominal))))
    larger = every.at(Explanation(drifts, own.variants), fit.values)
    columns = dict(zip(larger.explanation.names, larger.solution.jacobian.T, strict=True))
    remains = data.residual(fit.model, fit.switch)

    def share(quantity: Quantity) -> float:
        rest = without(own, quantity)
        try:
            lacking = every.models(rest, {name: fit.values[name] for name in rest.names})
        except InputError:
            return 0.0
        moves = data.residual(*lacking) - remains
        beside = [name for name in own.drifted if name != quantity]
        more = [name for name in drifts if name not in own.drifted] if isinstance(quantity, Variant) else []
        ways = ([columns[name] for name in (*beside, *also)] for also in [(), *((name,) for name in more)])
        return min(_share(data, moves, remains, way) for way in ways)

    return {quantity: share(quantity) for quantity in quantities(own)}


def _share(data: Data, moves: Signal, remains: Signal, columns: Sequence[Signal]) -> float:
    """The share with the `columns` taken out of both, as the samples that train have it."""
    both = np.stack([moves, remains], axis=1)
    if columns:
        known = np.stack(columns, axis=1)
        both = both - known @ np.linalg.lstsq(known[data.train], both[data.train], rcond=None)[0]
    parts = (np.mean(np.square(both[seen]), axis=0) for seen in (data.train, data.validation) if np.any(seen))
    return min(float(own / max(own + rest, 1e-300)) for own, rest in parts)
