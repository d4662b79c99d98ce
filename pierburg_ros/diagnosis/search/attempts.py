"""The explanations tried so far, each with its best fit, and the means to try more."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np

from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.race import winners
from pierburg_ros.diagnosis.search.screening import Candidate, most_promising, screened
from pierburg_ros.diagnosis.search.selection import alike, betters, tied
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.refinement import NEARLY, refined
from pierburg_ros.inference.explanation import Explanation, jumps
from pierburg_ros.plant import Model

LEADING = 0.25
"""Largest share of the squared error beyond the noise that one more quantity may leave. Up to this share, its
explanation may be refined, or grown before others of its size are tried. Measured: ripples that are there left 0.005 or
less before they were refined (n = 7 fits). Static friction with a drift left 0.17 (n = 1), two third quantities 0.02
and 0.12. In n = 4 recordings that nothing explains, all 16 refinements began at 0.27 or more. They took 10 to 60 s of
each recording, and none removed a tenth of its error."""
REFINED = 2
"""Number of fits of one size that are refined in one go. Work: each costs up to 18 descents; not varied."""
COMPARABLE = 1.5
"""Ratio of a fit's training error to that of the best fit of its size, up to which the fit is refined. Work: each
refinement costs up to 18 descents; not varied."""


class Attempts:
    """All explanations tried so far, each with its best fit, and the means to try more.

    `with_all_drifts` says whether an explanation is adequate where all parameters drift, None while that is not known.
    """

    def __init__(self, data: Data, nominal: Model, pool: Executor, progress: Progress, beam: Beam) -> None:
        self.data = data
        self.nominal = nominal
        self.beam = beam
        self.progress = progress
        self.drifts = drifting(nominal)
        self.whole = Estimator(data, nominal)
        self.alone = Estimator(data, nominal, pool.map)
        self.fits: dict[Explanation, Fit] = {}
        self.expanded: set[Explanation] = set()
        self.stood: set[Explanation] = set()
        self.tried = self.waiting = 0
        self.with_all_drifts: bool | None = None
        self.pool = pool

    @property
    def exhausted(self) -> bool:
        """Whether the budget of candidates is spent."""
        return self.tried >= self.beam.budget

    def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
        """Fit an explanation; gives the best fit of this explanation so far, which is kept."""
        self.progress(explanation.label)
        return self.keep(self.whole.fit(explanation, start))

    def keep(self, fit: Fit) -> Fit:
        """The best fit of the same explanation so far, `fit` included."""
        known = self.fits.get(fit.explanation)
        if known is None or fit.chi2 < known.chi2:
            self.fits[fit.explanation] = fit
        return self.fits[fit.explanation]

    def forget_deeper(self) -> None:
        """Forget the explanations with effects that have more quantities than the beam is deep."""
        for explanation in list(self.fits):
            if explanation.variants and explanation.size > self.beam.depth:
                del self.fits[explanation]

    def of_size(self, size: int) -> list[Fit]:
        """The fits of explanations with `size` quantities, the best first.

        A change in mid-recording has more freedom than a drift. It counts if it is adequate, or leaves less than half
        the chi2 of the best fit without one.
        """
        fits = sorted((fit for fit in list(self.fits.values()) if fit.explanation.size == size), key=_chi2)
        steady = next((fit.chi2 for fit in fits if fit.explanation.changed is None), np.inf)
        return [each for each in fits if not each.explanation.changed or each.chi2 < 0.5 * steady or adequate(each)]

    def best_of_size(self, size: int) -> Fit | None:
        """The best fit among explanations with `size` quantities, None if none was tried."""
        return next(iter(self.of_size(size)), None)

    def completed(self, size: int) -> bool:
        """Whether the best explanation of a `size` is adequate, so that no others of that size are needed."""
        best = self.best_of_size(size)
        return best is not None and adequate(best)

    def preferred(self, largest: int | None = None) -> Fit:
        """The smallest explanation that none up to the `largest` size betters; of ties, that with the fewest effects.

        Without a largest size, explanations with more quantities than the beam's depth count if they are adequate.
        """
        best = self.best_of_size(0)
        assert best is not None
        most = self.beam.depth if largest is None else largest
        for size in sorted({explanation.size for explanation in list(self.fits)} - {0}):
            rivals = self.of_size(size)[: self.beam.width]
            if size > most:
                rivals = [fit for fit in rivals if largest is None and adequate(fit)]
            best = next((fit for fit in rivals if betters(fit, best, self.whole)), best)
        return min(tied(best, self.of_size(best.explanation.size), self.whole), key=_preference)

    def least_drifted(self, but: Explanation | None = None) -> Fit:
        """The best fit so far with drifts only, or nominal; the explanation `but` does not count, unless nominal."""
        own = (fit.explanation for fit in list(self.fits.values()))
        drifted = (each for each in own if not each.variants and not each.changed and (each != but or not each.size))
        return min((self.fits[each] for each in drifted), key=_chi2)

    def nearest(self) -> Fit:
        """The fit with the lowest chi2 so far, among explanations within the beam's depth."""
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size <= self.beam.depth)
        return min(fits, key=_chi2)

    def expand(self, seed: Fit) -> list[Fit]:
        """Race the explanations with one quantity more than `seed`, once for each seed; gives the full fits made."""
        if seed.explanation in self.expanded:
            return []
        self.expanded.add(seed.explanation)
        candidates = [each for each in self.screened(seed) if not self._refuted(each.explanation)]
        known = self.best_of_size(seed.explanation.size + 1)
        if known is not None and adequate(known) and not adequate(seed):
            candidates = most_promising(candidates, self.beam.ahead // 3)
        return self.race(candidates)

    def _refuted(self, explanation: Explanation) -> bool:
        """Whether an explanation has at most one effect, and is not adequate even with all drifts added to it."""
        smooth = not jumps(explanation) and len(explanation.variants) <= 1
        return self.with_all_drifts is False and smooth and explanation.changed is None

    def screened(self, seed: Fit) -> list[Candidate]:
        """The candidates with one quantity more than `seed` that have not been fitted yet."""
        found = screened(seed, self.whole, self.drifts, self.pool, self.progress)
        return [candidate for candidate in found if candidate.explanation not in self.fits]

    def fit_most_promising(self, seeds: Sequence[Fit]) -> None:
        """Race the candidates on the `seeds` for which a linear step promises most: often one of them is adequate."""
        candidates = [candidate for seed in seeds for candidate in self.screened(seed)]
        self.race(most_promising(candidates, self.beam.ahead), most=self.beam.ahead // 3)

    def race(self, candidates: Sequence[Candidate], most: int | None = None) -> list[Fit]:
        """Full fits of the candidates that win the race.

        A candidate may be adequate on the samples of the race, but not as a full fit. If its cost has many local
        minima, it has stopped in one of them since, and is refined. So is an effect that leads the race beside drifts,
        with far less than they leave alone.
        """
        if not candidates:
            return []
        self.tried += len(candidates)
        self.waiting = len(candidates)
        known = self.best_of_size(candidates[0].explanation.size)
        leading = dict.fromkeys((self.whole, self.whole.first_part), known.ratio if known else np.inf)
        ahead = winners(candidates, leading, self.pool, self.progress, most)
        fits = list(self.pool.map(lambda fit: self.add(fit.explanation, fit.values), ahead))
        bases = {candidate.explanation: candidate.base for candidate in candidates}
        stopped = [
            fit
            for brief, fit in zip(ahead, fits, strict=True)
            if adequate(brief) and jumps(fit.explanation) and not adequate(fit)
        ]
        self.refine(stopped)
        if fits and self._lost(ahead[0], bases[fits[0].explanation]):
            self.refine_alone(self.fits[fits[0].explanation])
        return [self.fits[fit.explanation] for fit in fits]

    def _lost(self, brief: Fit, base: Fit) -> bool:
        """Whether an effect beside drifts lost to slips in the rest of the recording what its `brief` fit had gained.

        It gained that on its `base`, the drifts alone.
        """
        fit, begun = self.fits[brief.explanation], base.explanation
        gained = far_below(brief, base) and not far_below(fit, self.fits[begun])
        beside = bool(begun.drifted) and not begun.variants
        return beside and gained and jumps(fit.explanation) and not self.completed(fit.explanation.size)

    def refine_leading(self, size: int) -> None:
        """Refine the best fits of a `size`, if the leading one is adequate or leaves far less than every smaller one.

        A leading explanation that leaves nearly as much as a smaller one is not a true one that stopped early. A change
        in mid-recording is no smaller one, unless the leading explanation has one too.
        """
        leading = self.best_of_size(size)
        if leading is None:
            return
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size < size)
        smaller = (fit for fit in fits if leading.explanation.changed or not fit.explanation.changed)
        if adequate(leading) or far_below(leading, min(smaller, key=_chi2)):
            self.refine(self.of_size(size))

    def refine(self, fits: Iterable[Fit]) -> None:
        """Search for other local minima of those `fits` of one size that may gain by it, once for each fit."""
        fits = list(fits)
        best = self.best_of_size(fits[0].explanation.size) if fits else None
        if best is None:
            return
        chosen = [fit for fit in fits if near(fit, best)]
        if not adequate(best) and best.explanation.variants and (jumps(best.explanation) or best.ratio < NEARLY):
            chosen.append(best)
        chosen = [fit for fit in sorted(chosen, key=_chi2)[:REFINED] if not fit.refined]
        if len(chosen) == 1:
            self.refine_alone(chosen[0])
        else:
            list(self.pool.map(partial(self._refine, self.whole), chosen))

    def refine_alone(self, fit: Fit) -> None:
        """Search for other local minima of one fit, on all cores."""
        if not fit.refined:
            self._refine(self.alone, fit)

    def _refine(self, estimator: Estimator, fit: Fit) -> None:
        self.progress(f"{fit.explanation.label}, other local minima")
        again, known = refined(estimator, fit), self.fits.get(fit.explanation, fit)
        self.fits[fit.explanation] = replace(min(again, known, key=_chi2), refined=True)


def far_below(fit: Fit, smaller: Fit) -> bool:
    """Whether a fit leaves far less beyond the noise than a smaller one: it may be true and have stopped early."""
    return fit.ratio**2 - 1.0 < LEADING * (smaller.ratio**2 - 1.0)


def near(fit: Fit, best: Fit) -> bool:
    """Whether a fit with many local minima has almost the error of the best, without being tied with it."""
    return jumps(fit.explanation) and fit.ratio < COMPARABLE * best.ratio and alike(best) < fit.misfit


def _chi2(fit: Fit) -> float:
    return fit.chi2


def _preference(fit: Fit) -> tuple[int, bool, int, float]:
    """Sort key for ties: fewest effects, a drift before a change, fewest numbers, then lowest chi2."""
    explanation = fit.explanation
    return len(explanation.variants), explanation.changed is not None, len(explanation.names), fit.chi2
