"""Ripples of the load over angle or time, beside other changes: descents through stretches of the recordings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.diagnosis.evidence.missing_torque import MissingTorque, missing_torque
from pierburg_ros.diagnosis.evidence.stretches import REMEMBERED, restarted
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.fits import Fit, Search
from pierburg_ros.effects import EFFECTS, Effect
from pierburg_ros.effects.effect import Ripple as Declared
from pierburg_ros.effects.effect import Start

LENGTHS = (0.5, 1.0, 2.0, 4.0)
"""Lengths of the stretches [s] that are fitted in turn, before whole recordings."""
AMPLITUDES = (0.006, 0.012, 0.025)
"""Amplitudes [N.m] from which a descent may start."""
PHASES = tuple(math.pi / 4 * number for number in range(8))
"""Phases [rad] from which it may."""
BRIEF = 8
"""Iterations of a descent through stretches of one length."""
SHOWN = 0.75
"""Error over the shortest stretches, over that without the ripple, from which the ripple is not followed up."""
FOLLOWED = 2
"""How many explanations are."""


@dataclass(frozen=True)
class Ripple:
    """A sine in the load: its variant (amplitude, rhythm, phase), and where its rhythm may lie.

    A `held` rhythm is left where it starts until the last fit: it is a whole number, and trades against the phase.
    """

    variant: Variant
    rhythms: Callable[[MissingTorque], Sequence[float]]
    held: str | None = None

    @staticmethod
    def of(effect: Effect, declared: Declared) -> Ripple:
        """The ripple that an effect declares."""
        free = (declared.amplitude, declared.rhythm, declared.phase)
        held = f"{effect.id}.{declared.rhythm}" if declared.whole else None
        return Ripple(Variant(effect.id, free), declared.rhythms, held)

    @property
    def names(self) -> tuple[str, ...]:
        """Dotted names of amplitude, rhythm and phase."""
        return tuple(f"{self.variant.effect}.{name}" for name in self.variant.free)


RIPPLES = tuple(Ripple.of(effect, effect.ripple) for effect in EFFECTS if effect.ripple is not None)
"""Those that effects declare, over the angle with a whole number of periods a turn, or in time."""


def through_stretches(search: Search, ripple: Ripple, bases: Mapping[Explanation, Fit], pool: Executor) -> list[Fit]:
    """Fits of explanations with a `ripple`, each grown on the fit without it in `bases`: those where it explains most.

    The shaft rests where the ripple lets it, and setting off at the wrong crest displaces all that follows: a descent
    over a whole recording ends where one such moment is wrong. Stretches start from the measured state, and lengthen
    (multiple shooting; Voss, Timmer and Kurths, Nonlinear dynamical system identification from uncertain and indirect
    measurements, Int. J. Bifurcation and Chaos 14, 2004). Rhythms start from those of the missing torque. Heat and what
    changes in the middle cannot start afresh, and are left out; where the ripple explains little, the list is empty.
    """
    grown = [(explanation, base) for explanation, base in bases.items() if _restartable(explanation)]
    if not grown:
        return []
    short, *longer = (Search(restarted(search.data, length), search.nominal) for length in LENGTHS)
    start = _scanned(search, short, ripple, *min(grown, key=lambda pair: pair[1].chi2), pool)

    def descended(pair: tuple[Explanation, Fit]) -> Fit:
        return short.fit(pair[0], {**pair[1].values, **start}, BRIEF, held=ripple.held)

    def finished(fit: Fit) -> Fit:
        for stretches in longer:
            fit = stretches.fit(fit.explanation, fit.values, BRIEF, held=ripple.held)
        if ripple.held is not None:
            fit = search.fit(fit.explanation, fit.values, held=ripple.held)
        return search.fit(fit.explanation, fit.values)

    without = min(short.linearised(base).ratio for _, base in grown)
    shown = [fit for fit in pool.map(descended, grown) if fit.ratio < SHOWN * without]
    return list(pool.map(finished, sorted(shown, key=lambda fit: fit.ratio)[:FOLLOWED]))


def _restartable(explanation: Explanation) -> bool:
    return explanation.changed is None and REMEMBERED.isdisjoint(explanation.effects)


def _scanned(
    search: Search, short: Search, ripple: Ripple, explanation: Explanation, base: Fit, pool: Executor
) -> Start:
    """The ripple that leaves least over the shortest stretches on top of `base`."""
    missing = missing_torque(search.data, search.data.runs[0], base.model)
    rhythms = dict.fromkeys(ripple.rhythms(missing))
    starts = [dict(zip(ripple.names, row, strict=True)) for row in itertools.product(AMPLITUDES, rhythms, PHASES)]
    costs = pool.map(lambda start: short.chi2_at(explanation, {**base.values, **start}), starts)
    return min(zip(costs, starts, strict=True), key=lambda pair: pair[0])[1]
