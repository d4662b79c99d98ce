"""Which effects of an explanation of all are needed, counted against what would remain without them."""

from __future__ import annotations

from concurrent.futures import Executor
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts
from pierburg_ros.diagnosis.search.scored import scored, settled
from pierburg_ros.diagnosis.search.selection import SIGNIFICANT, names_all
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.explanation import Variant, without


def needed(best: Fit, attempts: Attempts, pool: Executor) -> Fit:
    """`best` without effects that do not make the recordings likelier by what names one, the least needed first.

    Against white noise nearly every effect gains that bends a little to what no effect describes. Without it that is a
    remainder, and costs no more than its few independent parts.
    """
    while names_all(best):
        variants = best.explanation.variants
        likely = min(scored(attempts.data, best).cost, best.chi2)
        gains = [cost - likely for cost in pool.map(partial(_without, best, attempts), variants)]
        least, variant = min(zip(gains, variants, strict=True), key=lambda pair: pair[0])
        if least >= SIGNIFICANT:
            return best
        best = attempts.add(without(best.explanation, variant), best.values)
    return best


def _without(best: Fit, attempts: Attempts, effect: Variant) -> float:
    """Minus twice the log likelihood without an effect, the others fitted again beside what then remains.

    Where white noise alone makes a residual likelier than the likeliest discrepancy that was found, there is none.
    """
    rest = without(best.explanation, effect)
    fit = attempts.fits.get(rest) or attempts.add(rest, best.values)
    return min(settled(attempts.data, attempts.nominal, fit).cost, fit.chi2)
