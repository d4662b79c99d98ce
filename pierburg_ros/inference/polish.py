"""The last digits of a fit: a search ends while a weakly told number may be some standard deviations from its best."""

from __future__ import annotations

import numpy as np

from pierburg_ros.inference.covariance import RANK
from pierburg_ros.inference.fit import Fit
from pierburg_ros.inference.intervals import slopes_at

POLISHED = 3
"""Linear steps after a search. Work: each takes a simulation or two for each number; near the minimum each leaves a
small part of the distance."""


def polished(found: Fit) -> Fit:
    """A fit after further linear steps by accurate slopes, as long as they lower its cost.

    A search ends where a step gains less than a ten-thousandth of the cost, some standard deviations of a number that a
    recording hardly tells.
    """
    fitter, explanation = found.fitter, found.explanation
    coordinates = fitter.coordinates(explanation)
    for _ in range(POLISHED if explanation.names else 0):
        move = np.linalg.lstsq(slopes_at(found, explanation), found.fitted, rcond=RANK)[0]
        point = np.clip(coordinates.point(found.values) - move, *coordinates.bounds)
        again = fitter.fit(explanation, {**found.values, **coordinates.values(point)}, 0)
        if again.chi2 >= found.chi2:
            break
        found = again
    return found
