"""Ripples of the load over angle or time, beside other changes: descents through stretches of the recordings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from concurrent.futures import Executor

from pierburg_ros.diagnosis.evidence.missing_torque import missing_torque
from pierburg_ros.diagnosis.evidence.stretches import forgotten, restarted
from pierburg_ros.diagnosis.search.candidates import possible
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Ripple
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant
from pierburg_ros.estimation.least_squares import BRIEF

LENGTHS = (5.25, 10.5, 21.0, 42.0)
"""Lengths of the stretches that are fitted in turn, before whole recordings, in the actuator's own time. Measured: 0.5
s of the valve ranks the number of teeth rightly in 10 of n = 10 trials of cogging in closed loop, 1 s in 9; each next
is twice as long."""
AMPLITUDES = (0.0022, 0.0045, 0.0093)
"""Amplitudes from which a descent may start, as shares of the stall torque. Chosen: a factor of two apart over what
blind trials conceal, 0.008 to 0.06 N.m of 2.7; not varied."""
PHASES = tuple(math.pi / 4 * number for number in range(8))
"""Phases [rad] from which it may. Measured: over whole recordings 0.3 rad beside the truth ends at 1.25 to 16 times
the noise (n = 2); an eighth of a turn leaves at most 0.4 rad, which short stretches bridge."""
SHOWN = 0.75
"""Error over the shortest stretches, over that without the ripple, from which the ripple is not followed up. Work:
what explains less costs five descents for nothing; not varied."""
FOLLOWED = 2
"""How many explanations are followed up. Work: each costs three descents through stretches and two whole ones; not
varied."""


def ripples(estimator: Estimator) -> list[tuple[Variant, Ripple]]:
    """The effects that may be a sine in the load of this actuator, in the order of the signal path."""
    declared = ((effect.id, effect.ripple) for effect in possible(estimator.data.actuator))
    return [
        (Variant(effect, (ripple.amplitude, ripple.rhythm, ripple.phase)), ripple)
        for effect, ripple in declared
        if ripple is not None
    ]


def through_stretches(
    estimator: Estimator, variant: Variant, ripple: Ripple, bases: Mapping[Explanation, Fit], pool: Executor
) -> list[Fit]:
    """Fits of explanations with a `ripple`, each grown on the fit without it in `bases`: those where it explains most.

    The shaft rests where the ripple lets it, and setting off at the wrong crest displaces all that follows: a descent
    over a whole recording ends where one such moment is wrong. Stretches start from the measured state, and lengthen
    (multiple shooting; Voss, Timmer and Kurths, Nonlinear dynamical system identification from uncertain and indirect
    measurements, Int. J. Bifurcation and Chaos 14, 2004). Rhythms start from those of the missing torque. What
    remembers longer than a stretch, or changes in the middle, cannot start afresh and is left out; where the ripple
    explains little, the list is empty.
    """
    grown = [(e, base) for e, base in bases.items() if e.changed is None and forgotten(e.effects)]
    if not grown:
        return []
    held = f"{variant.effect}.{ripple.rhythm}" if ripple.whole else None
    own = estimator.data.scales.time
    short, *longer = (Estimator(restarted(estimator.data, length * own), estimator.nominal) for length in LENGTHS)
    start = _scanned(estimator, short, variant, ripple, *min(grown, key=lambda pair: pair[1].chi2), pool)
    if start is None:
        return []

    def descended(pair: tuple[Explanation, Fit]) -> Fit:
        return short.fit(pair[0], {**pair[1].values, **start}, BRIEF, held=held)

    def finished(fit: Fit) -> Fit:
        for stretches in longer:
            fit = stretches.fit(fit.explanation, fit.values, BRIEF, held=held)
        if held is not None:
            fit = estimator.fit(fit.explanation, fit.values, held=held)
        return estimator.fit(fit.explanation, fit.values)

    without = min(short.restated(base).ratio for _, base in grown)
    shown = [fit for fit in pool.map(descended, grown) if fit.ratio < SHOWN * without]
    return list(pool.map(finished, sorted(shown, key=lambda fit: fit.ratio)[:FOLLOWED]))


def _scanned(
    estimator: Estimator,
    short: Estimator,
    variant: Variant,
    ripple: Ripple,
    explanation: Explanation,
    base: Fit,
    pool: Executor,
) -> dict[str, float] | None:
    """The ripple that leaves least over the shortest stretches on top of `base`, None where nothing has a rhythm."""
    missing = missing_torque(estimator.data, estimator.data.longest, base.model)
    effect, scales = EFFECT[variant.effect], base.model.scales
    rows = itertools.product(AMPLITUDES, dict.fromkeys(ripple.rhythms(missing)), PHASES)
    own = (effect.in_units(dict(zip(variant.free, row, strict=True)), scales) for row in rows)
    starts = [{f"{variant.effect}.{name}": value for name, value in start.items()} for start in own]
    costs = pool.map(lambda start: short.chi2_at(explanation, {**base.values, **start}), starts)
    return min(zip(costs, starts, strict=True), key=lambda pair: pair[0], default=(math.inf, None))[1]
