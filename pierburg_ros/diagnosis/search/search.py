"""The search: explanations from the smallest up, each grown by one more quantity, until another gains too little."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.race import winners
from pierburg_ros.diagnosis.search.ripple import between_rests, ripples
from pierburg_ros.diagnosis.search.screening import Candidate, most_promising, screened
from pierburg_ros.diagnosis.search.selection import accounts_for_all, adequate, alike, betters, complete, tied
from pierburg_ros.diagnosis.search.supported import Beside, supported
from pierburg_ros.diagnosis.search.together import drifting_apart, drifting_fewer
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import BLOCK, CYCLE, Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant, canonical, jumps, quantities, without
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
FEWER = 4
"""Combinations of as many drifting parameters that are fitted in the place of more, the best by a linear step. Work:
each is a whole fit; not varied."""
REFINED = 2
"""How many fits of one size are refined in one go. Work: each costs up to 18 descents; not varied."""
COMPARABLE = 1.5
"""Training error over that of the best explanation of its size up to which a fit is refined. Work: each refinement
costs up to 18 descents; not varied."""

AGAIN = 1.5
"""Times the trials made before it is asked what is likeliest beside a remainder that a search that resigns goes on for
after the answer. Measured: static friction beside a drift, of 20 s, is found after 0.93 (n = 1 recording, counted three
times, each the same); of n = 36 trials with two effects, a change, or an effect whose cost is rough, 35 ended before
that was asked, 34 of them right. Half as much again is for other processors, whose rounding leads elsewhere."""


class Resigned(BaseException):
    """The search has gone on in vain for long enough: like the end of the time it waits for nothing."""


@dataclass(frozen=True)
class Beam:
    """How wide, how deep and how long a search goes.

    Up to `width` explanations of one size are grown further, besides every single drift, and explanations have up to
    `depth` quantities, unless all that may drift does. Of all additions to them, the `ahead` most promising are fitted
    before the others. Once `budget` candidates have been fitted, explanations no longer grow. Where these leave
    something, and so does what is likeliest beside a remainder, a search that `resigns` fits no others, or not for long
    where little is left.
    """

    width: int = 3
    depth: int = 3
    ahead: int = 24
    budget: int = 1500
    resigns: bool = False


class Search:
    """All explanations tried so far, each with its best fit, and the means to try more."""

    def __init__(
        self, data: Data, nominal: Model, pool: Executor, progress: Progress = lambda _: None, beam: Beam | None = None
    ) -> None:
        self.data = data
        self.nominal = nominal
        self.beam = beam or Beam()
        self.progress = progress
        self.drifts = drifting(nominal)
        self.whole = Estimator(data, nominal)
        self.alone = Estimator(data, nominal, pool.map)
        self.first_part = Estimator(data.cut(FIRST_PART * data.scales.time), nominal)
        self.fits: dict[Explanation, Fit] = {}
        self.expanded: set[Explanation] = set()
        self.stood: set[Explanation] = set()
        self.rippled: set[int] = set()
        self.tried = self.waiting = 0
        self.pool = pool
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
        while size < self.beam.depth and not self.exhausted and not accounts_for_all(best, self.data):
            leading = best if best.explanation.size == size else self.best_of_size(size)
            if leading is None:
                break
            self._grow(leading)
            best = self.pruned()
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

    @property
    def exhausted(self) -> bool:
        """Whether the budget is spent."""
        return self.tried >= self.beam.budget

    def _grow(self, best: Fit) -> None:
        """Fit explanations with one quantity more than `best`, the cheap way first, until one leaves nothing.

        A ripple waits until what is most promising beside a drift has been tried, if anything will be: between rests it
        takes seconds, and beside a drift it is found as well as alone.
        """
        size = best.explanation.size
        if size and adequate(best):
            self._refine_alone(best)
            if accounts_for_all(self.fits[best.explanation], self.data):
                return
        seeds = self._seeds(best)
        if len(seeds) > 1:
            self._fit_most_promising(seeds)
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
            self._refine_leading(size)
            best = self.preferred(size)
            if accounts_for_all(best, self.data):
                return
            seeds = self._seeds(best)
        for seed in seeds:
            if self._complete(size + 1) or self.exhausted:
                return
            self.expand(seed)
            if not self._complete(size + 1) and (size or self.beam.depth == 1):
                self._fit_ripples(seeds)
            if self._wants_refinement(best, size + 1):
                self._refine_leading(size + 1)

    def _accounted_for(self, best: Fit) -> bool:
        """Whether something accounts for all by now, or does where what leads is grown.

        Where a ripple leads, it has to be looked for between rests first.
        """
        size = best.explanation.size
        if self._complete(size) or self._complete(size + 1):
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
        if leading is None or complete(leading):
            return
        self._fit_ripples(seeds)
        if jumps(leading.explanation) and not self._complete(size):
            self._refine_leading(size)

    def _followed(self, best: Fit) -> bool:
        """Grow what leads among the explanations one quantity larger than `best`, if it leaves far less.

        Whether that accounts for all: then nothing else of its size is looked for. Near the noise it may only have
        stopped too early, or another has.
        """
        size = best.explanation.size + 1
        leading = self.best_of_size(size)
        if leading is None or size == self.beam.depth:
            return False
        if leading.ratio < NEARLY or not _far_below(leading, best):
            return False
        self.expand(leading)
        return self._complete(size + 1)

    def _all_drift(self) -> bool:
        """Whether something accounts for all where all drifts that recordings tell apart; asked once.

        A description of guesses is off in more numbers than can be added one by one, and what is added before they are
        right stands for them. Effects are added to all of them, while each leaves far less. Then as few drift as have
        to.
        """
        if self.all_drifted or self.exhausted:
            return False
        self.all_drifted = True
        best = self.keep(self.recalibrated(self.pool))
        while not adequate(best):
            larger = min(self._acting_on(best), key=lambda fit: fit.chi2, default=best)
            if not adequate(larger) and not _far_below(larger, best):
                return False
            best = larger
        self._acting_instead(self._drifting_fewer(best))
        return True

    def _drifting_fewer(self, best: Fit) -> Fit:
        """Fit the effects of what accounts for all with ever fewer drifts, as long as these do; the last that does."""
        for count in range(len(best.explanation.drifted) - 1, -1, -1):
            begins = drifting_fewer(best, self.whole, self.drifts, count)[:FEWER]
            fewer = min(self.pool.map(lambda begin: self.add(*begin), begins), key=lambda fit: fit.chi2)
            if not adequate(fewer):
                break
            best = fewer
        return best

    def _acting_instead(self, best: Fit) -> None:
        """Fit what is most promising in the place of any two drifts of `best`: one effect may do what both do."""
        pairs = list(itertools.combinations(best.explanation.drifted, 2))
        if best.explanation.size > 2 and pairs:
            rests = (without(without(best.explanation, one), other) for one, other in pairs)
            self._fit_most_promising([self.add(rest, best.values) for rest in rests])

    def _acting_on(self, seed: Fit) -> list[Fit]:
        """Whole fits of effects added to `seed`."""
        acting = [each for each in self._screened(seed) if isinstance(each.addition, Variant)]
        return self._race(acting, most=self.beam.ahead // 3)

    def recalibrated(self, pool: Executor) -> Fit:
        """The nominal structure with as many of its parameters re-estimated as the recordings tell apart.

        From nominal values and from what leaves least so far where parameters drift.
        """
        explanation = drifting_apart(self.whole, self.drifts)
        starts = [self.nominal.values, self._drifted(but=explanation).values]
        fits = [*pool.map(lambda start: self.whole.fit(explanation, start), starts), self.fits.get(explanation)]
        return min(filter(None, fits), key=lambda fit: fit.chi2)

    def _drifted(self, but: Explanation | None = None) -> Fit:
        """What leaves least so far where parameters drift, if any, and nothing else; one explanation does not count."""
        own = (fit.explanation for fit in list(self.fits.values()))
        drifted = (each for each in own if not each.variants and not each.changed and (each != but or not each.size))
        return min((self.fits[each] for each in drifted), key=lambda fit: fit.chi2)

    def _drifts_expanded(self, seeds: Sequence[Fit]) -> bool:
        """Expand those of the `seeds` that only drift, before anything dear is done; whether that is the end.

        An effect beside a drift is more frequent than two effects, and found in a tenth of the time.
        """
        for seed in seeds:
            size = seed.explanation.size + 1
            if not seed.explanation.variants:
                self.expand(seed)
                if self._stopped_early(size):
                    self._refine_leading(size)
                if self._complete(size) or self.exhausted:
                    return True
        return False

    def _wants_refinement(self, best: Fit, size: int) -> bool:
        """Whether fits of a `size` grown from the `best` smaller one should be refined now.

        Single quantities wait until a pair of them has been tried, unless none betters the nominal model, or the best
        may only have stopped too early.
        """
        leading = self.best_of_size(size)
        if leading is None or adequate(best) or complete(leading):
            return False
        return size > 1 or self._stopped_early(size) or self.preferred(1).explanation.size == 0

    def _stopped_early(self, size: int) -> bool:
        """Whether the best of a `size` may only have stopped in a local minimum before it accounts for all."""
        leading = self.best_of_size(size)
        return leading is not None and not complete(leading) and jumps(leading.explanation) and leading.ratio < NEARLY

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

    def _fit_most_promising(self, seeds: Sequence[Fit]) -> None:
        """Fit what linear steps promise most on any of the `seeds`: often one of them accounts for all."""
        candidates = [candidate for seed in seeds for candidate in self._screened(seed)]
        self._race(most_promising(candidates, self.beam.ahead), most=self.beam.ahead // 3)

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
            self.resigned = in_vain or not jumps(self._nearest().explanation)
        return False

    def _nearest(self) -> Fit:
        """What leaves least so far, of what is added one by one."""
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size <= self.beam.depth)
        return min(fits, key=lambda fit: fit.chi2)

    def _least(self) -> float:
        """The least training error over noise so far."""
        return self._nearest().ratio

    def _fit_ripples(self, seeds: Sequence[Fit]) -> None:
        """Fit ripples of the load on top of the `seeds`, once, by the way that leads to them where the shaft slips."""
        size = seeds[0].explanation.size + 1
        if size in self.rippled:
            return
        self.rippled.add(size)
        # alone as well: drifts that have bent for a ripple hide it
        groups = (seeds, self.of_size(0)) if size == 2 else (seeds,)
        for begins, (variant, ripple) in itertools.product(groups, ripples(self.whole)):
            if self._complete(size) or self._complete(1):
                return
            self.progress(f"{variant.label}, between rests")
            grown = ((canonical(begin.explanation.plus(variant), self.drifts), begin) for begin in begins)
            bases = {explanation: begin for explanation, begin in grown if explanation is not None}
            fits = between_rests(self.whole, variant, ripple, bases, self.pool)
            for fit in map(self.keep, fits):
                begin = min(bases[fit.explanation], self._drifted(), key=lambda each: each.chi2)
                worth = fit.ratio < NEARLY and _far_below(fit, begin)
                if worth and not self._complete(fit.explanation.size):
                    self._refine_alone(fit)

    def expand(self, seed: Fit) -> list[Fit]:
        """Fit every explanation that has one quantity more than `seed`, once; gives the whole fits made."""
        if seed.explanation in self.expanded:
            return []
        self.expanded.add(seed.explanation)
        candidates = self._screened(seed)
        known = self.best_of_size(seed.explanation.size + 1)
        if known is not None and adequate(known) and not adequate(seed):
            candidates = most_promising(candidates, self.beam.ahead // 3)
        return self._race(candidates)

    def _screened(self, seed: Fit) -> list[Candidate]:
        """What has not been fitted yet of all that may be added to `seed`."""
        found = screened(seed, self.whole, self.first_part, self.drifts, self.pool, self.progress)
        return [candidate for candidate in found if candidate.explanation not in self.fits]

    def _race(self, candidates: Sequence[Candidate], most: int | None = None) -> list[Fit]:
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

    def _refine_leading(self, size: int) -> None:
        """Refine what leads among explanations of a `size`.

        Not where it leaves nearly as much as something smaller: then it is not the truth that stopped early.
        """
        leading = self.best_of_size(size)
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size < size)
        smaller = min(fits, key=lambda fit: fit.chi2)
        if leading is not None and (adequate(leading) or _far_below(leading, smaller)):
            self.refine(self.of_size(size))

    def refine(self, fits: Iterable[Fit]) -> None:
        """Search other local minima of the fits of one size that may gain by it, once each."""
        fits = list(fits)
        best = self.best_of_size(fits[0].explanation.size) if fits else None
        if best is None:
            return
        chosen = [fit for fit in fits if _near(fit, best)]
        if not adequate(best) and best.explanation.variants and (jumps(best.explanation) or best.ratio < NEARLY):
            chosen.append(best)
        chosen = [fit for fit in sorted(chosen, key=lambda fit: fit.chi2)[:REFINED] if not fit.refined]
        if len(chosen) == 1:
            self._refine_alone(chosen[0])
        else:
            list(self.pool.map(partial(self._refine, self.whole), chosen))

    def _refine_alone(self, fit: Fit) -> None:
        """Search other local minima of one fit, on all cores."""
        if not fit.refined:
            self._refine(self.alone, fit)

    def _refine(self, estimator: Estimator, fit: Fit) -> None:
        self.progress(f"{fit.explanation.label}, other local minima")
        self.fits[fit.explanation] = refined(estimator, fit)

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

    def best_of_size(self, size: int) -> Fit | None:
        """The best fit among explanations of `size` quantities, None where none was tried."""
        return next(iter(self.of_size(size)), None)

    def of_size(self, size: int) -> list[Fit]:
        """The fits of explanations of `size` quantities, the best first."""
        fits = (fit for fit in list(self.fits.values()) if fit.explanation.size == size)
        return sorted(fits, key=lambda fit: fit.chi2)

    def _complete(self, size: int) -> bool:
        """Whether an explanation of a size leaves nothing to look for among its like."""
        best = self.best_of_size(size)
        return best is not None and complete(best)

    def pruned(self) -> Fit:
        """The preferred explanation after each of its parts has been fitted again from its values.

        A smaller explanation that had stopped in a local minimum gets its chance before a larger one wins: from the
        lowest of the larger one's minima, since from beside it the smaller one may stop again (one that leaves nothing
        is at its lowest). So does one with a drift in the place of two of its quantities, or of an effect. Whichever
        is preferred then has to stand the same.
        """
        while (best := self.preferred()).explanation not in self.stood:
            self.stood.add(best.explanation)
            may_gain = best.ratio < NEARLY and not accounts_for_all(best, self.data)
            if best.explanation.size > 1 and jumps(best.explanation) and may_gain:
                self._refine_alone(best)
                best = self.fits[best.explanation]
            for quantity in quantities(best.explanation):
                smaller = self.add(without(best.explanation, quantity), best.values)
                if _near(smaller, best):
                    self._refine_alone(smaller)
            for simpler in (_smaller(best.explanation, self.drifts), _simpler(best.explanation, self.drifts)):
                self.refine(list(self.pool.map(partial(self.add, start=best.values), simpler)))
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


def _far_below(fit: Fit, smaller: Fit) -> bool:
    """Whether a fit leaves far less beyond the noise than a smaller one: it may be the truth that stopped early."""
    return fit.ratio**2 - 1.0 < LEADING * (smaller.ratio**2 - 1.0)


def _near(fit: Fit, best: Fit) -> bool:
    """Whether events jump in a fit, and it comes near the best without being its equal."""
    return jumps(fit.explanation) and fit.ratio < COMPARABLE * best.ratio and alike(best) < fit.misfit


def _preference(fit: Fit) -> tuple[int, bool, int, float]:
    """Order among explanations that fit alike: least effects, a drift before a change, least numbers, then by fit."""
    explanation = fit.explanation
    return len(explanation.variants), explanation.changed is not None, len(explanation.names), fit.chi2
