"""Descents that an event at the wrong moment does not end: through stretches of the recordings, which lengthen."""

from __future__ import annotations

from pierburg_ros.diagnosis.explanation import Explanation
from pierburg_ros.diagnosis.hypotheses import TIMED
from pierburg_ros.diagnosis.restarts import restarted
from pierburg_ros.diagnosis.search import Fit, Search, Start

LENGTHS = (1.0, 2.0, 4.0)
"""Lengths of the stretches [s] that are fitted in turn, before whole recordings."""


def unstuck(search: Search, explanation: Explanation, start: Start, iterations: int) -> Fit:
    """Best values of an explanation from `start`, by a way on which the cost has fewer local minima.

    Each stretch starts from the measured state, so that a slip at the wrong moment does not displace all that follows
    (multiple shooting; Voss, Timmer and Kurths, Nonlinear dynamical system identification from uncertain and indirect
    measurements, Int. J. Bifurcation and Chaos 14, 2004). What goes by the clock cannot start afresh: there large
    errors count by their logarithm at first. `iterations`: of each fit.
    """
    values = dict(start)
    if explanation.changed is not None or not TIMED.isdisjoint(explanation.effects):
        values = search.fit(explanation, values, iterations, forgiving=True).values
    else:
        for length in LENGTHS:
            stretches = Search(restarted(search.data, length), search.nominal)
            values = stretches.fit(explanation, values, iterations).values
    return search.fit(explanation, values, iterations)
