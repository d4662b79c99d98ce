"""Which effects of an adequate explanation are needed, compared with the remainder that is left without them."""

from __future__ import annotations

from concurrent.futures import Executor
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts
from pierburg_ros.diagnosis.search.scored import scored, settled
from pierburg_ros.diagnosis.search.selection import names_all
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.inference.explanation import Variant, without


def needed(best: Fit, attempts: Attempts, pool: Executor) -> Fit:
    """`best` without the effects that make the recordings less than `SIGNIFICANT` more likely, the least needed first.

    Against white noise, nearly every effect gains by adapting a little to an error that no effect describes. Without
    the effect this error is a remainder, and costs no more than its few independent parts.
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
    """Minus twice the log likelihood without an effect, the others fitted again with the remainder that is then left.

    If white noise alone makes the residual more likely than the best discrepancy found, there is no discrepancy.
    """
    rest = without(best.explanation, effect)
    fit = attempts.fits.get(rest) or attempts.add(rest, best.values)
    return min(settled(attempts.data, attempts.nominal, fit).cost, fit.chi2)
