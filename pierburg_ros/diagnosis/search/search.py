"""The search: explanations from the smallest up, each grown by one more quantity, until another gains too little."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np

from pierburg_ros.diagnosis.search.attempts import Attempts, far_below
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.diagnosis.search.ripple import between_rests, ripples
from pierburg_ros.diagnosis.search.selection import adequate, names_all
from pierburg_ros.diagnosis.search.supported import Beside, supported
from pierburg_ros.diagnosis.search.together import drift_together
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.explanation import Explanation, canonical, jumps
from pierburg_ros.estimation.refinement import NEARLY
from pierburg_ros.plant import Model

AGAIN = 1.5
"""Times the trials made before it is asked what is likeliest beside a remainder that a search that resigns goes on for
after the answer. Measured: static friction beside a drift, of 20 s, is found after 0.93 (n = 1 recording, counted three
times, each the same); of n = 36 trials with two effects, a change, or an effect whose cost is rough, 35 ended before
that was asked, 34 of them right. Half as much again is for other processors, whose rounding leads elsewhere."""


class Resigned(BaseException):
    """The search has gone on in vain for long enough: like the end of the time it waits for nothing."""


class Search(Attempts):
    """What is tried after what: the cheap and the frequent first."""

    def __init__(
        self, data: Data, nominal: Model, pool: Executor, progress: Progress = lambda _: None, beam: Beam | None = None
    ) -> None:
        super().__init__(data, nominal, pool, progress, beam or Beam())
        self.rippled: set[int] = set()
        self.beside: Beside | None = None
        self.all_drifted = False
        self.resigned = False
        self._told, self._until = 0, math.inf

    def run(self) -> Fit:
        """Grow explanations until the best leaves nothing or cannot be bettered; gives that best one.

        Where no explanation of a size betters the smaller ones, but these do not account for all either, the next size
        is tried all the same: two quantities may do what neither does alone. So is the next size where something larger
        is known that does not account for all.
        """
        best, size = self.add(Explanation()), 0
        while size < self.beam.depth and not self.exhausted and not names_all(best):
            leading = best if best.explanation.size == size else self.best_of_size(size)
            if leading is None:
                break
            self._grow(leading)
            best = pruned(self)
            if best.explanation.size <= size and adequate(best):
                break
            size = max(size + 1, best.explanation.size if adequate(best) else 0)
        return best

    def check(self) -> None:
        """Count one more trial: `Resigned` once there were enough after it was asked what is likeliest.

        Not where an explanation accounts for all by now, which is to be held against others. Trials are counted, not
        timed: a verdict must not depend on how fast the machine is.
        """
        self._told += 1
        if self._told > self._until and not any(adequate(fit) for fit in list(self.fits.values())):
            self.resigned = True
            raise Resigned

    def _grow(self, best: Fit) -> None:
        """Fit explanations with one quantity more than `best`, the cheap way first, until one leaves nothing.

        A ripple waits until what is most promising beside a drift has been tried, if anything will be: between rests it
        takes seconds, and beside a drift it is found as well as alone.
        """
        size = best.explanation.size
        seeds = self._seeds(best)
        if len(seeds) > 1:
            self.fit_most_promising(seeds)
            if self._accounted_for(best):
                return
            if not self.resigned:
                self._lead_tried_harder(seeds, size + 1)
            if self._accounted_for(best):
                return
            if self._likeliest_accounts_for_all():
                return
            if self.resigned or self._drifts_expanded(seeds):
                return
            self.refine_leading(size)
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
        """Whether something accounts for all by now, or does where what leads is grown.

        Where a ripple leads, it has to be looked for between rests first.
        """
        size = best.explanation.size
        if self.completed(size) or self.completed(size + 1):
            return True
        leading = self.best_of_size(size + 1)
        rhythmic = leading is not None and any(EFFECT[one].ripple for one in leading.explanation.effects)
        if rhythmic and size + 1 not in self.rippled:
            return False
        return self._followed(best) or self._all_drift()

    def _lead_tried_harder(self, seeds: Sequence[Fit], size: int) -> None:
        """Descend again to what leads among explanations of a `size`, if its cost has many local minima.

        Ripples come first, for they are found in less time than a minimum among many.
        """
        leading = self.best_of_size(size)
        if leading is None or adequate(leading):
            return
        self._fit_ripples(seeds)
        if jumps(leading.explanation) and not self.completed(size):
            self.refine_leading(size)

    def _followed(self, best: Fit) -> bool:
        """Grow what leads among the explanations one quantity larger than `best`, if it leaves far less.

        Whether that accounts for all: then nothing else of its size is looked for. Near the noise it may only have
        stopped too early, or another has.
        """
        size = best.explanation.size + 1
        leading = self.best_of_size(size)
        if leading is None or size == self.beam.depth:
            return False
        if leading.ratio < NEARLY or not far_below(leading, best):
            return False
        self.expand(leading)
        return self.completed(size + 1)

    def _all_drift(self) -> bool:
        """Whether something accounts for all where all drift that recordings tell apart; asked once."""
        if self.all_drifted or self.exhausted:
            return False
        self.all_drifted = True
        return drift_together(self)

    def _drifts_expanded(self, seeds: Sequence[Fit]) -> bool:
        """Expand those of the `seeds` that only drift, before anything dear is done; whether that is the end.

        An effect beside a drift is more frequent than two effects, and found in a tenth of the time.
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
        """Whether fits of a `size` grown from the `best` smaller one should be refined now.

        Single quantities wait until a pair of them has been tried, unless none betters the nominal model, or the best
        may only have stopped too early.
        """
        leading = self.best_of_size(size)
        if leading is None or adequate(best) or adequate(leading):
            return False
        return size > 1 or self._stopped_early(size) or self.preferred(1).explanation.size == 0

    def _stopped_early(self, size: int) -> bool:
        """Whether the best of a `size` may only have stopped in a local minimum before it accounts for all."""
        leading = self.best_of_size(size)
        return leading is not None and not adequate(leading) and jumps(leading.explanation) and leading.ratio < NEARLY

    def _seeds(self, best: Fit) -> list[Fit]:
        """Fits of the size of `best` worth growing: itself, and while nothing is adequate its rivals.

        Single drifts come first: an effect beside a drift is more frequent than two effects, and found sooner. A
        change in the middle has more freedom than a drift, and must fit that much better.
        """
        size = best.explanation.size
        if adequate(best):
            return [best]
        rivals = self.of_size(size)
        steady = min((fit.chi2 for fit in rivals if fit.explanation.changed is None), default=np.inf)
        rivals = [fit for fit in rivals if fit.explanation.changed is None or fit.chi2 < 0.5 * steady]
        drifts = [fit for fit in rivals if not fit.explanation.variants and size == 1]
        return list({id(fit): fit for fit in (*drifts, *rivals[: self.beam.width])}.values())

    def _likeliest_accounts_for_all(self) -> bool:
        """Whether what is likeliest beside a remainder leaves nothing, fitted as if there were none; asked once.

        It is not refined where something else comes far nearer. A search that resigns does so here where too much is
        left and nothing comes near the noise, without refining anything. It does as well where no event jumps in what
        comes nearest: its cost is smooth, and what linear steps promise has been fitted.
        """
        if self.beside is not None:
            return False
        before = self._told
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
            self._until = self._told + AGAIN * before
            self.resigned = in_vain or not jumps(self.nearest().explanation)
        return False

    def _least(self) -> float:
        """The least training error over noise so far."""
        return self.nearest().ratio

    def _fit_ripples(self, seeds: Sequence[Fit]) -> None:
        """Fit ripples of the load on top of the `seeds`, once, by the way that leads to them where the shaft slips."""
        size = seeds[0].explanation.size + 1
        if size in self.rippled:
            return
        self.rippled.add(size)
        # alone as well: drifts that have bent for a ripple hide it
        groups = (seeds, self.of_size(0)) if size == 2 else (seeds,)
        for begins, (variant, ripple) in itertools.product(groups, ripples(self.whole)):
            if self.completed(size) or self.completed(1):
                return
            self.progress(f"{variant.label}, between rests")
            grown = ((canonical(begin.explanation.plus(variant), self.drifts), begin) for begin in begins)
            bases = {explanation: begin for explanation, begin in grown if explanation is not None}
            fits = between_rests(self.whole, variant, ripple, bases, self.pool)
            for fit in map(self.keep, fits):
                begin = min(bases[fit.explanation], self.least_drifted(), key=lambda each: each.chi2)
                worth = fit.ratio < NEARLY and far_below(fit, begin)
                if worth and not self.completed(fit.explanation.size):
                    self.refine_alone(fit)
