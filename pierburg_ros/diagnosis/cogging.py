"""Cogging beside other changes: descents through stretches of the recordings, with a whole number of teeth."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from concurrent.futures import Executor

from pierburg_ros.diagnosis.explanation import TEETH, Explanation
from pierburg_ros.diagnosis.hypotheses import COGGING, Start, turns
from pierburg_ros.diagnosis.restarts import REMEMBERED, restarted
from pierburg_ros.diagnosis.search import Fit, Search
from pierburg_ros.diagnosis.torque_residual import missing_torque

NAMES = tuple(f"{COGGING.effect}.{name}" for name in COGGING.free)
LENGTHS = (0.5, 1.0, 2.0, 4.0)
"""Lengths of the stretches [s] that are fitted in turn, before whole recordings."""
AMPLITUDES = (0.006, 0.012, 0.025)
"""Amplitudes [N.m] from which a descent may start."""
PHASES = tuple(math.pi / 4 * number for number in range(8))
"""Phases [rad] from which it may."""
BRIEF = 8
"""Iterations of a descent through stretches of one length."""
SHOWN = 0.75
"""Error over the shortest stretches, over that without cogging, from which cogging is not followed up."""
FOLLOWED = 2
"""How many explanations are."""


def through_stretches(search: Search, bases: Mapping[Explanation, Fit], pool: Executor) -> list[Fit]:
    """Fits of explanations with cogging, each grown on the fit without it in `bases`: those where it explains most.

    The shaft rests between two poles, and leaving one too early displaces all that follows: a descent over a whole
    recording ends where one such moment is wrong. Stretches start from the measured state, and lengthen (multiple
    shooting; Voss, Timmer and Kurths, Nonlinear dynamical system identification from uncertain and indirect
    measurements, Int. J. Bifurcation and Chaos 14, 2004). The number of teeth is held at whole ones near the rhythms of
    the missing torque, for it trades against the phase; the last fit sets it free. Heat and what changes in the middle
    cannot start afresh, and are left out; where cogging explains little, the list is empty.
    """
    grown = [(explanation, base) for explanation, base in bases.items() if _restartable(explanation)]
    if not grown:
        return []
    short, *longer = (Search(restarted(search.data, length), search.nominal) for length in LENGTHS)
    start = _scanned(search, short, *min(grown, key=lambda pair: pair[1].chi2), pool)

    def descended(pair: tuple[Explanation, Fit]) -> Fit:
        return short.fit(pair[0], {**pair[1].values, **start}, BRIEF, held=TEETH)

    def finished(fit: Fit) -> Fit:
        for stretches in longer:
            fit = stretches.fit(fit.explanation, fit.values, BRIEF, held=TEETH)
        fit = search.fit(fit.explanation, fit.values, held=TEETH)
        return search.fit(fit.explanation, fit.values)

    without = min(short.linearised(base).ratio for _, base in grown)
    shown = [fit for fit in pool.map(descended, grown) if fit.ratio < SHOWN * without]
    return list(pool.map(finished, sorted(shown, key=lambda fit: fit.ratio)[:FOLLOWED]))


def _restartable(explanation: Explanation) -> bool:
    return explanation.changed is None and REMEMBERED.isdisjoint(explanation.effects)


def _scanned(search: Search, short: Search, explanation: Explanation, base: Fit, pool: Executor) -> Start:
    """The cogging that leaves least over the shortest stretches on top of `base`."""
    missing = missing_torque(search.data, search.data.runs[0], base.model)
    teeth = dict.fromkeys(max(1.0, float(round(rhythm))) for rhythm in turns(missing, base.model))
    starts = [dict(zip(NAMES, row, strict=True)) for row in itertools.product(AMPLITUDES, teeth, PHASES)]
    costs = pool.map(lambda start: short.chi2_at(explanation, {**base.values, **start}), starts)
    return min(zip(costs, starts, strict=True), key=lambda pair: pair[0])[1]
