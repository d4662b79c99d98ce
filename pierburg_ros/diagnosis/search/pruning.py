"""The last step of a search: what is preferred has to stand against smaller and simpler explanations."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts, near
from pierburg_ros.diagnosis.search.selection import names_all
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.explanation import Explanation, canonical, jumps, quantities, without
from pierburg_ros.estimation.refinement import NEARLY


def pruned(attempts: Attempts) -> Fit:
    """The preferred explanation after each of its parts has been fitted again from its values.

    A smaller explanation that had stopped in a local minimum gets its chance before a larger one wins: from the lowest
    of the larger one's minima, since from beside it the smaller one may stop again (one that leaves nothing is at its
    lowest). So does one with a drift in the place of two of its quantities, or of an effect. Whichever is preferred
    then has to stand the same.
    """
    while (best := attempts.preferred()).explanation not in attempts.stood:
        attempts.stood.add(best.explanation)
        may_gain = best.ratio < NEARLY and not names_all(best)
        if best.explanation.size > 1 and jumps(best.explanation) and may_gain:
            attempts.refine_alone(best)
            best = attempts.fits[best.explanation]
        for quantity in quantities(best.explanation):
            smaller = attempts.add(without(best.explanation, quantity), best.values)
            if near(smaller, best):
                attempts.refine_alone(smaller)
        for simpler in (_smaller(best.explanation, attempts.drifts), _simpler(best.explanation, attempts.drifts)):
            attempts.refine(list(attempts.pool.map(partial(attempts.add, start=best.values), simpler)))
    return best


def _smaller(explanation: Explanation, drifts: tuple[str, ...]) -> list[Explanation]:
    """An explanation with a drift in the place of two of its quantities, where events jump beside it."""
    pairs = itertools.combinations(quantities(explanation), 2)
    return _drifting_too(filter(jumps, (without(without(explanation, one), other) for one, other in pairs)), drifts)


def _simpler(explanation: Explanation, drifts: tuple[str, ...]) -> list[Explanation]:
    """An explanation with a drift in the place of one of its effects, where another effect stays."""
    if len(explanation.variants) < 2:
        return []
    return _drifting_too((without(explanation, variant) for variant in explanation.variants), drifts)


def _drifting_too(rests: Iterable[Explanation], drifts: tuple[str, ...]) -> list[Explanation]:
    """Each of the `rests` with each of the `drifts`."""
    found = (Explanation((*rest.drifted, name), rest.variants, rest.changed) for rest in rests for name in drifts)
    return [each for each in dict.fromkeys(canonical(each, drifts) for each in found) if each is not None]
