"""A base parameter that changed in the middle of a recording: read off the balance, then fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.coordinates import Coordinates
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation
from pierburg_ros.inference.fit import Fit
from pierburg_ros.inference.least_squares import beside
from pierburg_ros.inference.shortlist import balanced, sloped

MOMENTS = 60
"""Moments of a recording at which a change is tried. Work: a fit moves a moment on from there; not varied."""
FROM_ENDS = 0.05
"""Share of the recording before and after a change. Derived: a fit searches it within 3 to 97 % of the recording."""


@dataclass(frozen=True)
class Change:
    """A start of a fit in which a parameter changes: the explanation, and values by dotted name."""

    explanation: Explanation
    values: dict[str, float]


def changes(fit: Fit, balance: Balance, names: Sequence[str]) -> list[Change]:
    """A change of each base parameter of `names`, at the moment at which one would lower the error of the balance most.

    Beside the drifts of a `fit`: what they scale with as a whole may still change alone. None for several recordings: a
    change is at a time of one.
    """
    if len(balance.motions) > 1 or fit.explanation.changed is not None:
        return []
    nominal, drifted = fit.fitter.nominal, fit.explanation.drifted
    acting = fit.explanation.effects
    values, inside = balanced(balance, nominal, drifted, fit.values, acting)
    coordinates = Coordinates(tuple(names), nominal, balance.duration)
    left, slopes = sloped(inside, nominal, names, values, acting)
    basis = np.linalg.qr(slopes[:, [names.index(name) for name in drifted]])[0]
    left = beside(left, basis)
    time, end = inside.motions[0].time, balance.duration

    def steps(moment: float) -> tuple[Signal, Signal]:
        """The best step of each parameter then, and by how much it lowers the squared error, each shape (names,)."""
        columns = beside(np.where(time[:, np.newaxis] >= moment, slopes, 0.0), basis)
        size = np.maximum(np.sum(np.square(columns), axis=0), 1e-300)
        step = -(columns.T @ left) / size
        return step, np.square(step) * size

    moment = max(np.linspace(FROM_ENDS, 1.0 - FROM_ENDS, MOMENTS) * end, key=lambda each: float(np.max(steps(each)[1])))
    found = []
    for name, axis, step in zip(names, coordinates.axes, steps(moment)[0], strict=True):
        after = axis.value(float(np.clip(axis.coordinate(values[name]) + step, axis.lower, axis.upper)))
        own = Explanation(tuple(n for n in drifted if n != name), fit.explanation.variants, name)
        found.append(Change(own, {**values, name + AFTER: after, name + WHEN: float(moment)}))
    return found
