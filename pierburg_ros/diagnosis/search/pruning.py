"""The last step of a search: the preferred explanation is compared with smaller and simpler ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts, near
from pierburg_ros.diagnosis.search.candidates import with_drifts
from pierburg_ros.diagnosis.search.selection import names_all
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.refinement import NEARLY
from pierburg_ros.inference.explanation import Explanation, jumps, quantities, without


def pruned(attempts: Attempts) -> Fit:
    """The preferred explanation, after smaller and simpler ones have been fitted again from its values.

    A smaller explanation that had stopped in a local minimum is fitted again before a larger one wins. It starts from
    the lowest minimum of the larger one: from a point beside that, it may stop again. (A larger one that leaves only
    noise is at its lowest already.) Explanations with a drift in place of two quantities, or of an effect, are fitted
    in the same way. The explanation that is preferred after that is tested in turn.
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
    """The explanations with a drift in place of two quantities, where the other quantities have many local minima."""
    pairs = itertools.combinations(quantities(explanation), 2)
    return _drifting_too(filter(jumps, (without(without(explanation, one), other) for one, other in pairs)), drifts)


def _simpler(explanation: Explanation, drifts: tuple[str, ...]) -> list[Explanation]:
    """The explanations with a drift in place of one effect, where another effect stays."""
    if len(explanation.variants) < 2:
        return []
    return _drifting_too((without(explanation, variant) for variant in explanation.variants), drifts)


def _drifting_too(rests: Iterable[Explanation], drifts: tuple[str, ...]) -> list[Explanation]:
    """Each of the `rests` with each of the `drifts` added."""
    return list(dict.fromkeys(each for rest in rests for each in with_drifts(rest, drifts, 1)))
