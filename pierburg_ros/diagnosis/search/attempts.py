"""The explanations tried so far, each with its best fit, and the means to try more."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from functools import partial

import numpy as np

from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.race import winners
from pierburg_ros.diagnosis.search.screening import Candidate, most_promising, screened
from pierburg_ros.diagnosis.search.selection import adequate, alike, betters, tied
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.data import BLOCK, CYCLE, Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, jumps
from pierburg_ros.estimation.refinement import NEARLY, refined
from pierburg_ros.plant import Model

FIRST_PART = 2 * CYCLE * BLOCK
"""How much of a recording a first fit takes in, in the actuator's own time. Derived: two cycles of eight blocks, so
that every kind of block is there twice."""
LEADING = 0.25
"""Share of the squared error beyond the noise that one more quantity leaves at most for its explanation to be refined,
or grown before others of its size are tried. Measured: ripples that are there left 0.005 or less before they were
refined (n = 7 fits), static friction beside a drift 0.17 (n = 1), two third quantities 0.02 and 0.12; all 16
refinements in n = 4 recordings that nothing explains began at 0.27 or more, took 10 to 60 s of each, and none took a
tenth of its error away."""
REFINED = 2
"""How many fits of one size are refined in one go. Work: each costs up to 18 descents; not varied."""
COMPARABLE = 1.5
"""Training error over that of the best explanation of its size up to which a fit is refined. Work: each refinement
costs up to 18 descents; not varied."""


class Attempts:
    """All explanations tried so far, each with its best fit, and the means to try more."""

    def __init__(self, data: Data, nominal: Model, pool: Executor, progress: Progress, beam: Beam) -> None:
        self.data = data
        self.nominal = nominal
        self.beam = beam
        self.progress = progress
        self.drifts = drifting(nominal)
        self.whole = Estimator(data, nominal)
        self.alone = Estimator(data, nominal, pool.map)
        self.first_part = Estimator(data.cut(FIRST_PART * data.scales.time), nominal)
        self.fits: dict[Explanation, Fit] = {}
        self.expanded: set[Explanation] = set()
        self.stood: set[Explanation] = set()
        self.tried = self.waiting = 0
        self.pool = pool

    @property
    def exhausted(self) -> bool:
        """Whether the budget is spent."""
        return self.tried >= self.beam.budget

    def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
        """Fit an explanation and keep it if it is the best of its kind so far."""
        self.progress(explanation.label)
        return self.keep(self.whole.fit(explanation, start))

    def keep(self, fit: Fit) -> Fit:
        """The best fit of the same explanation so far, `fit` included."""
        known = self.fits.get(fit.explanation)
        if known is None or fit.chi2 < known.chi2:
            self.fits[fit.explanation] = fit
        return self.fits[fit.explanation]

    def of_size(self, size: int) -> list[Fit]:
        """The fits of explanations of `size` quantities, the best first."""
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size == size)
        return sorted(fits, key=lambda fit: fit.chi2)

    def best_of_size(self, size: int) -> Fit | None:
        """The best fit among explanations of `size` quantities, None where none was tried."""
        return next(iter(self.of_size(size)), None)

    def completed(self, size: int) -> bool:
        """Whether an explanation of a size leaves nothing to look for among its like."""
        best = self.best_of_size(size)
        return best is not None and adequate(best)

    def preferred(self, largest: int | None = None) -> Fit:
        """The smallest explanation that none up to the `largest` size betters; of equals, that with least effects.

        Without a largest size what has more quantities than the beam is deep counts where it accounts for all.
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
        """What leaves least so far where parameters drift, if any, and nothing else; one explanation does not count."""
        own = (fit.explanation for fit in list(self.fits.values()))
        drifted = (each for each in own if not each.variants and not each.changed and (each != but or not each.size))
        return min((self.fits[each] for each in drifted), key=lambda fit: fit.chi2)

    def nearest(self) -> Fit:
        """What leaves least so far, of what is added one by one."""
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size <= self.beam.depth)
        return min(fits, key=lambda fit: fit.chi2)

    def expand(self, seed: Fit) -> list[Fit]:
        """Fit every explanation that has one quantity more than `seed`, once; gives the whole fits made."""
        if seed.explanation in self.expanded:
            return []
        self.expanded.add(seed.explanation)
        candidates = self.screened(seed)
        known = self.best_of_size(seed.explanation.size + 1)
        if known is not None and adequate(known) and not adequate(seed):
            candidates = most_promising(candidates, self.beam.ahead // 3)
        return self.race(candidates)

    def screened(self, seed: Fit) -> list[Candidate]:
        """What has not been fitted yet of all that may be added to `seed`."""
        found = screened(seed, self.whole, self.first_part, self.drifts, self.pool, self.progress)
        return [candidate for candidate in found if candidate.explanation not in self.fits]

    def fit_most_promising(self, seeds: Sequence[Fit]) -> None:
        """Fit what linear steps promise most on any of the `seeds`: often one of them accounts for all."""
        candidates = [candidate for seed in seeds for candidate in self.screened(seed)]
        self.race(most_promising(candidates, self.beam.ahead), most=self.beam.ahead // 3)

    def race(self, candidates: Sequence[Candidate], most: int | None = None) -> list[Fit]:
        """Whole fits of the candidates that come out ahead.

        One that had accounted for the samples it raced on, and not for all, has stopped in a local minimum since.
        """
        if not candidates:
            return []
        self.tried += len(candidates)
        self.waiting = len(candidates)
        known = self.best_of_size(candidates[0].explanation.size)
        leading = dict.fromkeys((self.whole, self.first_part), known.ratio if known else np.inf)
        ahead = winners(candidates, leading, self.pool, self.progress, most)
        fits = list(self.pool.map(lambda fit: self.add(fit.explanation, fit.values), ahead))
        stopped = [
            fit
            for brief, fit in zip(ahead, fits, strict=True)
            if adequate(brief) and jumps(fit.explanation) and not adequate(fit)
        ]
        self.refine(stopped)
        return [self.fits[fit.explanation] for fit in fits]

    def refine_leading(self, size: int) -> None:
        """Refine what leads among explanations of a `size`.

        Not where it leaves nearly as much as something smaller: then it is not the truth that stopped early.
        """
        leading = self.best_of_size(size)
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size < size)
        smaller = min(fits, key=lambda fit: fit.chi2)
        if leading is not None and (adequate(leading) or far_below(leading, smaller)):
            self.refine(self.of_size(size))

    def refine(self, fits: Iterable[Fit]) -> None:
        """Search other local minima of the fits of one size that may gain by it, once each."""
        fits = list(fits)
        best = self.best_of_size(fits[0].explanation.size) if fits else None
        if best is None:
            return
        chosen = [fit for fit in fits if near(fit, best)]
        if not adequate(best) and best.explanation.variants and (jumps(best.explanation) or best.ratio < NEARLY):
            chosen.append(best)
        chosen = [fit for fit in sorted(chosen, key=lambda fit: fit.chi2)[:REFINED] if not fit.refined]
        if len(chosen) == 1:
            self.refine_alone(chosen[0])
        else:
            list(self.pool.map(partial(self._refine, self.whole), chosen))

    def refine_alone(self, fit: Fit) -> None:
        """Search other local minima of one fit, on all cores."""
        if not fit.refined:
            self._refine(self.alone, fit)

    def _refine(self, estimator: Estimator, fit: Fit) -> None:
        self.progress(f"{fit.explanation.label}, other local minima")
        self.fits[fit.explanation] = refined(estimator, fit)


def far_below(fit: Fit, smaller: Fit) -> bool:
    """Whether a fit leaves far less beyond the noise than a smaller one: it may be the truth that stopped early."""
    return fit.ratio**2 - 1.0 < LEADING * (smaller.ratio**2 - 1.0)


def near(fit: Fit, best: Fit) -> bool:
    """Whether events jump in a fit, and it comes near the best without being its equal."""
    return jumps(fit.explanation) and fit.ratio < COMPARABLE * best.ratio and alike(best) < fit.misfit


def _preference(fit: Fit) -> tuple[int, bool, int, float]:
    """Order among explanations that fit alike: least effects, a drift before a change, least numbers, then by fit."""
    explanation = fit.explanation
    return len(explanation.variants), explanation.changed is not None, len(explanation.names), fit.chi2
