"""The search: it grows explanations from the smallest, one quantity at a time, until one more gains too little."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from concurrent.futures import Executor

from pierburg_ros.diagnosis.search.attempts import Attempts, far_below
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.candidates import with_drifts
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.diagnosis.search.ripple import between_rests, ripples
from pierburg_ros.diagnosis.search.selection import names_all
from pierburg_ros.diagnosis.search.supported import Beside, supported
from pierburg_ros.diagnosis.search.together import drift_together
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.estimation.refinement import NEARLY
from pierburg_ros.inference.explanation import Explanation, canonical, jumps, without
from pierburg_ros.plant import Model


class Search(Attempts):
    """The order of the trials: cheap and frequent explanations come first."""

    def __init__(
        self, data: Data, nominal: Model, pool: Executor, progress: Progress = lambda _: None, beam: Beam | None = None
    ) -> None:
        super().__init__(data, nominal, pool, progress, beam or Beam())
        self.rippled: set[int] = set()
        self.beside: Beside | None = None
        self.resigned = False

    def run(self) -> Fit:
        """Grow explanations until the best is adequate or cannot be bettered; gives the best one.

        If no explanation of a size betters the smaller ones, and these are not adequate, the next size is still tried.
        Two quantities may do what neither does alone. The next size is also tried if a larger explanation is the best
        but is not adequate.
        """
        best, size = self.add(Explanation()), 0
        while size < self.beam.depth and not self.exhausted and not names_all(best):
            leading = best if best.explanation.size == size else self.best_of_size(size)
            if leading is None:
                break
            self._grow(leading)
            if self.resigned:
                break
            best = pruned(self)
            if best.explanation.size <= size and adequate(best):
                break
            size = max(size + 1, best.explanation.size if adequate(best) else 0)
        return best

    def _grow(self, best: Fit) -> None:
        """Fit explanations with one quantity more than `best`, the cheap way first, until one is adequate.

        A ripple waits until the most promising additions to a drift have been tried, if any will be. A fit between
        rests takes seconds, and a ripple is found with a drift as well as alone. The leading drift is grown in any
        case. A search that resigns ends after the others have been grown, or before.
        """
        size = best.explanation.size
        seeds = self._seeds(best)
        if len(seeds) > 1:
            self.fit_most_promising(seeds)
            if self._accounted_for(best):
                return
            self._lead_tried_harder(seeds, size + 1)
            if self._accounted_for(best):
                return
            if self._drifts_expanded(seeds[:1]) or self._likeliest_accounts_for_all():
                return
            if self.resigned or self._drifts_expanded(seeds):
                return
            self.refine_leading(size)
            if self.beam.resigns:
                self.refine_leading(size + 1)
                self.resigned = not (self.completed(size) or self.completed(size + 1))
                return
            best = self.preferred(size)
            if names_all(best):
                return
            seeds = self._seeds(best)
        for seed in seeds:
            if self.completed(size + 1) or self.exhausted:
                return
            self.expand(seed)
            if not self.completed(size + 1) and (size or self.beam.depth == 1):
                self._fit_ripples(seeds)
            if self._wants_refinement(best, size + 1):
                self.refine_leading(size + 1)

    def _accounted_for(self, best: Fit) -> bool:
        """Whether an adequate explanation is known, or is found by growing the leading one or with all drifts together.

        If a ripple leads, it is first fitted between rests. What may only have stopped too early is refined first.
        """
        size = best.explanation.size
        if self.completed(size) or self.completed(size + 1):
            return True
        leading = self.best_of_size(size + 1)
        rhythmic = leading is not None and any(EFFECT[one].ripple for one in leading.explanation.effects)
        if rhythmic and size + 1 not in self.rippled:
            return False
        return self._finished(size + 1) or self._followed(best) or self._all_drift()

    def _finished(self, size: int) -> bool:
        """Whether the leading explanation of a `size` is adequate, once refined if it may have stopped too early."""
        leading = self.best_of_size(size)
        if leading is not None and self._stopped_early(size):
            self._refine_and_exchange(leading)
        return self.completed(size)

    def _refine_and_exchange(self, leading: Fit) -> None:
        """Refine what leads, once; if it is still not adequate, its drift may be the wrong one."""
        if not leading.refined:
            self.refine_alone(leading)
            self._exchange_drift(self.fits[leading.explanation])

    def _lead_tried_harder(self, seeds: Sequence[Fit], size: int) -> None:
        """Refine the leading explanation of a `size`, if its cost has many local minima.

        Ripples come first: they are found in less time than one minimum among many.
        """
        leading = self.best_of_size(size)
        if leading is None or adequate(leading):
            return
        self._fit_ripples(seeds)
        if jumps(leading.explanation) and not self.completed(size):
            # a ripple that led may have been refined by then
            self._refine_and_exchange(self.fits[leading.explanation])

    def _exchange_drift(self, fit: Fit) -> None:
        """Put each other drift in the place of the one beside the effects of a `fit`, and refine what is better so.

        A wrong drift may stand in for the true one along most of a recording, while the effect's values are nearly
        right.
        """
        drifted = fit.explanation.drifted
        if adequate(fit) or len(drifted) != 1:
            return
        among = with_drifts(without(fit.explanation, drifted[0]), self.drifts, 1)
        others = [other for other in among if other != fit.explanation]
        exchanged = self.pool.map(lambda other: self.add(other, fit.values), others)
        best = min(exchanged, key=lambda each: each.chi2, default=fit)
        if best.chi2 < fit.chi2:
            self.refine_alone(best)

    def _followed(self, best: Fit) -> bool:
        """Grow the leading fit of the next size, if it leaves far less than `best`; gives whether one is adequate.

        If so, no other explanation of its size is tried. A leading explanation whose events jump is not grown before it
        is refined: it may only have stopped too early. Ripples come first: they take less time than all else.
        """
        size = best.explanation.size + 1
        leading = self.best_of_size(size)
        if leading is None or size == self.beam.depth:
            return False
        early = jumps(leading.explanation) and not leading.refined
        if early or not far_below(leading, best):
            return False
        self._fit_ripples([leading])
        if not self.completed(size + 1):
            self.expand(leading)
        return self._finished(size + 1)

    def _all_drift(self) -> bool:
        """Whether an explanation is adequate where all parameters drift that recordings distinguish; evaluated once."""
        if self.with_all_drifts is not None or self.exhausted:
            return False
        self.with_all_drifts = drift_together(self)
        return self.with_all_drifts

    def _drifts_expanded(self, seeds: Sequence[Fit]) -> bool:
        """Expand those of the `seeds` that have no effect, before any expensive step; gives whether to end there.

        An effect with a drift is more frequent than two effects, and is found in a tenth of the time.
        """
        for seed in seeds:
            size = seed.explanation.size + 1
            if not seed.explanation.variants:
                self.expand(seed)
                if self._stopped_early(size):
                    self.refine_leading(size)
                if self.completed(size) or self.exhausted:
                    return True
        return False

    def _wants_refinement(self, best: Fit, size: int) -> bool:
        """Whether fits of a `size` that grew from the smaller `best` should be refined now.

        Single quantities wait until a pair of them has been tried, unless none betters the nominal model, or the best
        one may only have stopped too early.
        """
        leading = self.best_of_size(size)
        if leading is None or adequate(best) or adequate(leading):
            return False
        return size > 1 or self._stopped_early(size) or self.preferred(1).explanation.size == 0

    def _stopped_early(self, size: int) -> bool:
        """Whether the best of a `size` may have stopped in a local minimum before it became adequate."""
        leading = self.best_of_size(size)
        return leading is not None and not adequate(leading) and jumps(leading.explanation) and leading.ratio < NEARLY

    def _seeds(self, best: Fit) -> list[Fit]:
        """Fits of the size of `best` that are worth growing: `best` itself and, if it is not adequate, its rivals.

        Single drifts come first: an effect with a drift is more frequent than two effects, and is found sooner.
        """
        size = best.explanation.size
        if adequate(best):
            return [best]
        rivals = self.of_size(size)
        drifts = [fit for fit in rivals if not fit.explanation.variants and size == 1]
        return list({id(fit): fit for fit in (*drifts, *rivals[: self.beam.width])}.values())

    def _likeliest_accounts_for_all(self) -> bool:
        """Whether the most likely explanation beside a remainder is adequate when fitted without one; evaluated once.

        It is not refined if another explanation has a far smaller error. A search that resigns does so here, without
        refining anything, if too much is left and nothing comes near the noise. It also resigns if the cost of the best
        fit is smooth: no other local minimum is to be looked for. The additions for which linear steps promise most
        have been fitted by then.
        """
        if self.beside is not None:
            return False
        self.beside = supported(self.data, self.nominal, list(self.fits.values()), self.pool, self.progress)
        reached = self.beside.reached.fit
        in_reach = reached.explanation.size <= self.beam.depth
        if in_reach:
            self.add(reached.explanation, reached.values)
        in_vain = self.beam.resigns and not (in_reach and self.beside.open) and self._least() >= NEARLY
        if in_reach:
            fit = self.fits[reached.explanation]
            if fit.ratio < NEARLY * self._least() and not in_vain:
                self.refine([fit])
            if adequate(self.fits[reached.explanation]):
                return True
        if self.beam.resigns:
            self.resigned = in_vain or not jumps(self.nearest().explanation)
        return False

    def _least(self) -> float:
        """The least training error over noise so far, among explanations within the beam's depth."""
        return self.nearest().ratio

    def _fit_ripples(self, seeds: Sequence[Fit]) -> None:
        """Fit ripples of the load on top of the `seeds`, once, between rests: this finds them where the shaft slips.

        A ripple that comes near the noise there is refined from there. Slips may keep it far from the noise along whole
        recordings.
        """
        size = seeds[0].explanation.size + 1
        if size in self.rippled:
            return
        self.rippled.add(size)
        # an effect or a drift that has adapted to a ripple hides it: drifts without effects, and the nominal model too
        nearest = min(seeds, key=lambda seed: seed.chi2)
        drifted = [seed for seed in seeds if not seed.explanation.variants]
        groups = [drifted, seeds] if nearest.explanation.variants else [seeds]
        groups += [self.of_size(0)] if size == 2 else []
        for begins, (variant, ripple) in itertools.product(filter(None, groups), ripples(self.whole)):
            if self.completed(size) or self.completed(1):
                return
            self.progress(f"{variant.label}, between rests")
            grown = ((canonical(begin.explanation.plus(variant), self.drifts), begin) for begin in begins)
            bases = {explanation: begin for explanation, begin in grown if explanation is not None}
            for fit, smooth in between_rests(self.whole, variant, ripple, bases, self.pool):
                kept, near = self.keep(fit), min(fit.ratio, smooth.ratio) < NEARLY
                if near and not kept.refined and not self.completed(fit.explanation.size):
                    self.refine_alone(self.whole.at(fit.explanation, smooth.values))
