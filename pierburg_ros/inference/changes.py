"""A base parameter that changed in the middle of a recording: read off the balance, then fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
    """The change of each base parameter of `names` that would lower the error of the balance most, best first.

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
    found = []
    for place, name in enumerate(names):
        for moment in np.linspace(FROM_ENDS, 1.0 - FROM_ENDS, MOMENTS) * end:
            column = beside(np.where(time >= moment, slopes[:, place], 0.0), basis)
            size = float(column @ column)
            if size > 0.0:
                step = -float(column @ left) / size
                found.append((step**2 * size, name, float(moment), step))
    best: dict[str, Change] = {}
    for _, name, moment, step in sorted(found, reverse=True):
        if name not in best:
            axis = coordinates.axes[names.index(name)]
            after = axis.value(float(np.clip(axis.coordinate(values[name]) + step, axis.lower, axis.upper)))
            own = Explanation(tuple(n for n in drifted if n != name), fit.explanation.variants, name)
            best[name] = Change(own, {**values, name + AFTER: after, name + WHEN: moment})
    return list(best.values())
