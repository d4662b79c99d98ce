"""Ripples of the load over angle or time, added to other changes: descents between the rests of the shaft."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor

from pierburg_ros.diagnosis.evidence.missing_torque import missing_torque
from pierburg_ros.diagnosis.evidence.stretches import forgotten
from pierburg_ros.diagnosis.search.attempts import far_below
from pierburg_ros.diagnosis.search.candidates import possible
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Ripple
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.first_part import takes_time, where_shown
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.least_squares import BRIEF

AMPLITUDE = 0.0022
"""Amplitude from which descents start, as a share of the stall torque. Measured: with the right drift, a descent leads
to the number of teeth in 16 of n = 17 trials of cogging (amplitudes of 0.003 to 0.014). From twice the amplitude, it
does so in 14. A small amplitude lowers the error wherever its rhythm and phase are right."""
PHASES = tuple(math.pi / 4 * number for number in range(8))
"""Phases [rad] from which descents may start. Measured: over whole recordings, a start 0.3 rad from the true phase ends
at 1.25 to 16 times the noise (n = 2). With steps of an eighth of a turn, a start is at most 0.4 rad away, and the costs
between rests bridge that."""
FOLLOWED = 2
"""Number of explanations that are followed up. Work: each costs two descents along whole recordings; not varied."""


def ripples(estimator: Estimator) -> list[tuple[Variant, Ripple]]:
    """The effects that may be a sine in the load of this actuator, in the order of the signal path."""
    declared = ((effect.id, effect.ripple) for effect in possible(estimator.data.actuator))
    return [
        (Variant(effect, (ripple.amplitude, ripple.rhythm, ripple.phase)), ripple)
        for effect, ripple in declared
        if ripple is not None
    ]


def between_rests(
    whole: Estimator,
    variant: Variant,
    ripple: Ripple,
    bases: Mapping[Explanation, Fit],
    pool: Executor,
) -> list[tuple[Fit, Fit]]:
    """Fits of explanations with a `ripple`, each grown on the fit without it in `bases`: the `FOLLOWED` best ones.

    The shaft rests where the ripple lets it. If it sets off at the wrong crest, everything after that is displaced, so
    a descent over a whole recording ends where one such moment is wrong. Between rests this does not happen, and the
    first part of each recording will do if it shows the error. For the base with the lowest error, one descent starts
    from the best phase of each rhythm that lowers this error. Bases with a change in mid-recording, or with an effect
    that remembers longer than a rest, are left out. If no rhythm leaves far less error between rests, nothing is given.
    Each is given as a fit of `whole` recordings, and as the fit between rests from which that has descended.
    """
    grown = {e: base for e, base in bases.items() if e.changed is None and forgotten(e.effects)}
    if not grown:
        return []
    nearest = min(grown.values(), key=lambda base: base.chi2)
    rests = (whole if takes_time(variant) else where_shown(nearest, whole)[0]).between_rests
    begins = [(explanation, rests.restated(base)) for explanation, base in grown.items()]
    held = f"{variant.effect}.{ripple.rhythm}" if ripple.whole else None

    def descended(explanation: Explanation, values: Mapping[str, float]) -> Fit:
        return rests.fit(explanation, values, BRIEF, held=held)

    def finished(smooth: Fit) -> tuple[Fit, Fit]:
        fit = smooth if held is None else whole.fit(smooth.explanation, smooth.values, held=held)
        return whole.fit(fit.explanation, fit.values), smooth

    explanation, base = min(begins, key=lambda pair: pair[1].chi2)
    rhythms = ripple.rhythms(missing_torque(whole.data, whole.data.longest, base.model))
    starts = _scanned(rests, variant, ripple, rhythms, explanation, base, pool)
    found = list(pool.map(lambda start: descended(explanation, {**base.values, **start}), starts))
    lowest = min(found, key=lambda fit: fit.chi2, default=None)
    if lowest is None or not far_below(lowest, base):
        return []
    own = {name: value for name, value in lowest.values.items() if name.startswith(f"{variant.effect}.")}
    others = [(e, other) for e, other in begins if e != explanation]
    found = [lowest, *pool.map(lambda pair: descended(pair[0], {**pair[1].values, **own}), others)]
    return list(pool.map(finished, sorted(found, key=lambda fit: fit.chi2)[:FOLLOWED]))


def _scanned(
    rests: Estimator,
    variant: Variant,
    ripple: Ripple,
    rhythms: Iterable[float],
    explanation: Explanation,
    base: Fit,
    pool: Executor,
) -> list[dict[str, float]]:
    """The best start of each of the `rhythms` that lowers the error of `base` between rests, at one small amplitude."""
    effect, scales = EFFECT[variant.effect], base.model.scales
    rows = [(AMPLITUDE, *row) for row in itertools.product(dict.fromkeys(rhythms), PHASES)]
    own = (effect.in_units(dict(zip(variant.free, row, strict=True)), scales) for row in rows)
    starts = [{f"{variant.effect}.{name}": value for name, value in start.items()} for start in own]
    costs = pool.map(lambda start: rests.chi2_at(explanation, {**base.values, **start}), starts)
    best: dict[float, dict[str, float]] = {}
    for cost, (_, rhythm, _), start in sorted(zip(costs, rows, starts, strict=True), key=lambda each: each[0]):
        if cost < base.chi2:
            best.setdefault(rhythm, start)
    return list(best.values())
