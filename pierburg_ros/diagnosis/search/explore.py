"""The exploration of explanations, from the smallest up: what else could be the case, and how well would it fit?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from pierburg_ros.diagnosis.evidence.data import EvidenceData, after_choice
from pierburg_ros.diagnosis.search.candidates import drifting, is_rough
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant, canonical, quantities, without
from pierburg_ros.diagnosis.search.fits import Fit, Search
from pierburg_ros.diagnosis.search.refinement import polished
from pierburg_ros.diagnosis.search.ripples import RIPPLES, Ripple, through_stretches
from pierburg_ros.diagnosis.search.screening import PROMISING, Outlook, Prospect, most_promising
from pierburg_ros.diagnosis.search.selection import (
    ADEQUATE,
    accounts_for_all,
    adequate,
    alike,
    betters,
    complete,
    overlooks,
    tied,
)
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model

Progress = Callable[[str], None]

NEAR = 5.0
"""Training error over noise up to which the best explanation may only have stopped too early."""
RIVALS = 3
"""Explanations of one size that may better a smaller one, and that are grown while none is adequate, besides every
single drift."""
GLANCE = 24.0
"""How much of a recording [s] a first look takes in."""
BRIEF, FULL = 6, 25
"""Iterations of a first look, and of a whole fit."""
TASTE = 3
"""Iterations of a first look after which a hopeless one ends."""
HOPELESS = 3.0
"""Error over that of the best explanation of the same size from which a first look is hopeless."""
REPLACING = 8
"""Explanations promising most on a seed that are looked at where another of the same size accounts for all."""
TRIED_FIRST = 24
"""Explanations promising most on any seed that are looked at before all seeds are grown in turn."""
LOOKED_AT = 8
"""How many of those are followed up by a brief fit."""
FINISHED = 4
"""How many of the best first looks are always followed by a whole fit."""
SHARPENED = 2
"""How many of the best whole fits with a rough cost are looked over again in each round."""
COMPARABLE = 1.5
"""Training error over that of the best explanation of its size up to which a fit is looked over again."""
FADING = (0.75, 0.5, 0.25, 0.0)
"""Shares of an effect's strength at which what may stand for it is fitted in turn."""
LARGEST = 3
"""Explanations of more quantities than this are not tried."""


@dataclass(frozen=True)
class Look:
    """A brief fit of a prospect from one of its starts."""

    prospect: Prospect
    start: Start
    fit: Fit


class Exploration:
    """All explanations tried so far, each with its best fit."""

    def __init__(self, data: EvidenceData, nominal: Model, progress: Progress = lambda _: None) -> None:
        self.search = Search(data, nominal)
        self.glance = Search(data.cut(GLANCE), nominal)
        self.drifts = drifting(nominal)
        self.outlook = Outlook(self.search, self.glance, self.drifts, progress)
        self.data = data
        self.nominal = nominal
        self.fits: dict[Explanation, Fit] = {}
        self._grown: set[Explanation] = set()
        self._sharp: set[Explanation] = set()
        # fitted ahead of their turn, from one seed: growing another may find a better start
        self._hasty: set[Explanation] = set()
        self.progress = progress

    def run(self) -> Fit:
        """Explore until the best explanation cannot be bettered by one more quantity; gives that best one."""
        with threadpool_limits(1):
            self.add(Explanation())
            self.grow(Explanation())
            best = self.preferred(1)
            while best.explanation.size < LARGEST and not accounts_for_all(best, self.data):
                size = best.explanation.size
                if adequate(best):
                    self.grow(best.explanation)
                else:
                    self._enlarge(size)
                best = self._pruned()
                if best.explanation.size <= size:
                    break
            return best

    def _enlarge(self, size: int) -> None:
        """Look for explanations with one quantity more than `size`, the cheap way first, until one leaves nothing."""
        self._try_first(self._promising(self.preferred(size)))
        if self._complete(size + 1):
            return
        self.sharpen(self.of_size(size))
        best = self.preferred(size)
        if accounts_for_all(best, self.data):
            return
        seeds = self._promising(best)
        for ripple in RIPPLES:
            self._try_ripple(ripple, seeds)
            if self._complete(size + 1):
                return
        for seed in seeds:
            self.grow(seed)
            if not self._complete(size + 1):
                self.sharpen(self.of_size(size + 1))
            if self._complete(size + 1):
                return

    def _complete(self, size: int) -> bool:
        """Whether an explanation of a size leaves nothing to look for among its like."""
        best = self.best_of_size(size)
        return best is not None and complete(best)

    def add(self, explanation: Explanation, start: Start | None = None, iterations: int = FULL) -> Fit:
        """Fit an explanation and keep it if it is the best of its kind so far."""
        return self._keep(self.search.fit(explanation, start, iterations))

    def _keep(self, fit: Fit) -> Fit:
        """The best fit of the same explanation so far, `fit` included."""
        known = self.fits.get(fit.explanation)
        if known is None or fit.chi2 < known.chi2:
            self.fits[fit.explanation] = fit
        return self.fits[fit.explanation]

    def consider(self, explanation: Explanation, faded: Variant, rival: Fit) -> None:
        """Fit an explanation that stands for an effect of `rival` by other means, if it keeps up as the effect fades.

        In one step the others would have to take over all of it at once, and events would jump; so would they if its
        other effects gave way meanwhile. What acts all the time like a change of a base parameter needs no search.
        """
        values = rival.values
        part, base = EFFECT[faded.effect].constant_part or ("", "")
        if base in explanation.drifted:
            self.add(explanation, {**values, base: values[base] + values[f"{faded.effect}.{part}"]})
        held = tuple(_faded(variant, rival, 1.0) for variant in explanation.variants)
        for share in FADING:
            fading = (*held, _faded(faded, rival, share)) if share > 0.0 else held
            stage = Explanation(explanation.drifted, fading, explanation.changed)
            try:
                look = self.glance.fit(stage, values, BRIEF)
            except InputError:
                continue
            if look.ratio > 1.3 * rival.ratio:
                return
            values = look.values
        fit = self.add(explanation, values)
        self.add(explanation, fit.values)

    def preferred(self, largest: int = LARGEST) -> Fit:
        """The smallest explanation that none up to the `largest` size betters; of equals, that with least effects."""
        best = self.best_of_size(0)
        assert best is not None
        for size in range(1, largest + 1):
            larger = sorted(self.of_size(size), key=lambda fit: fit.chi2)[:RIVALS]
            best = next((fit for fit in larger if betters(fit, best, self.search)), best)
        return min(tied(best, self.of_size(best.explanation.size), self.search), key=_preference)

    def best_of_size(self, size: int) -> Fit | None:
        """The best fit among explanations of `size` quantities, None where none was tried."""
        return min(self.of_size(size), key=lambda fit: fit.chi2, default=None)

    def of_size(self, size: int) -> list[Fit]:
        """The fits of explanations of `size` quantities."""
        return [fit for fit in list(self.fits.values()) if fit.explanation.size == size]

    def _pruned(self) -> Fit:
        """The preferred explanation after each of its parts has been fitted again from its values.

        A smaller explanation that had stopped in a local minimum gets its chance before a larger one wins; where its
        cost is rough and it comes near, it is looked over again.
        """
        best = self.preferred()
        while True:
            for quantity in quantities(best.explanation):
                smaller = self.add(without(best.explanation, quantity), best.values)
                if _deserves_sharpening(smaller, best):
                    self._sharpen(smaller)
            kept = self.preferred()
            if kept.explanation.size >= best.explanation.size:
                return kept
            best = kept

    def sharpen(self, fits: Sequence[Fit]) -> None:
        """Look fits of one size over again: rough ones near the best of all, and the best if near the noise."""
        best = self.best_of_size(fits[0].explanation.size) if fits else None
        if best is None:
            return
        chosen = [fit for fit in fits if _deserves_sharpening(fit, best)]
        if not adequate(best) and best.explanation.variants and (is_rough(best.explanation) or best.ratio < NEAR):
            chosen.append(best)
        chosen = sorted(chosen, key=lambda fit: fit.chi2)[:SHARPENED]
        with ThreadPoolExecutor(2) as pool:
            list(pool.map(self._sharpen, chosen))

    def _promising(self, best: Fit) -> list[Explanation]:
        """Explanations of the size of `best` worth growing: itself, and while nothing is adequate its rivals.

        Single drifts come first: an effect beside a drift is more frequent than two effects, and found sooner.
        """
        size = best.explanation.size
        if adequate(best):
            return [best.explanation]
        rivals = [fit for fit in self.fits.values() if fit.explanation.size == size]
        steady = [fit.chi2 for fit in rivals if fit.explanation.changed is None]
        rivals = [f for f in rivals if f.explanation.changed is None or f.chi2 < 0.5 * min(steady, default=np.inf)]
        rivals.sort(key=lambda fit: fit.chi2)
        alone = [fit.explanation for fit in rivals if not fit.explanation.variants and size == 1]
        return list(dict.fromkeys(alone + [fit.explanation for fit in rivals[:RIVALS]]))

    def _try_first(self, seeds: list[Explanation]) -> None:
        """Fit what linear steps promise most on any of the `seeds`.

        Often one of them accounts for all, long before every seed is grown.
        """
        if len(seeds) < 2:
            return
        with ThreadPoolExecutor(2) as pool:
            prospects = [prospect for seed in seeds for prospect in self.outlook.on(self._base(seed), self.fits, pool)]
            promising = most_promising(prospects, TRIED_FIRST)
            tastes = [taste for tasted in pool.map(self._taste, promising) for taste in tasted]
            looks = list(pool.map(self._look, _best_looks(tastes)[:LOOKED_AT]))
            fits = list(pool.map(self._finish, [look.fit for look in _best_looks(looks)[:FINISHED]]))
        self._hasty |= {fit.explanation for fit in fits}

    def _try_ripple(self, ripple: Ripple, seeds: list[Explanation]) -> None:
        """Fit a ripple on top of the `seeds` by the one way that leads to it where the shaft has slipped."""
        if len(seeds) < 2:
            return
        self.progress(f"{ripple.variant.label}, through stretches")
        grown = ((canonical(seed.plus(ripple.variant), self.drifts), seed) for seed in seeds)
        bases = {explanation: self._base(seed) for explanation, seed in grown if explanation is not None}
        with ThreadPoolExecutor(2) as pool:
            fits = [self._keep(fit) for fit in through_stretches(self.search, ripple, bases, pool)]
        self.sharpen(fits)

    def grow(self, seed: Explanation) -> list[Fit]:
        """Fit every explanation that has one quantity more than `seed`, once; gives the whole fits made."""
        if seed in self._grown:
            return []
        self._grown.add(seed)
        base = self._base(seed)
        with ThreadPoolExecutor(2) as pool:
            prospects = self.outlook.on(base, self.fits.keys() - self._hasty, pool)
            known = self.best_of_size(seed.size + 1)
            if known is not None and adequate(known) and not adequate(base):
                prospects = most_promising(prospects, REPLACING)
            tastes = [taste for tasted in pool.map(self._taste, prospects) for taste in tasted]
            looks = list(pool.map(self._look, self._hopeful(tastes, seed.size + 1)))
            fits = list(pool.map(self._finish, self._worth_finishing(base, _best_looks(looks))))
        self._hasty -= {fit.explanation for fit in fits}
        return fits

    def _base(self, seed: Explanation) -> Fit:
        return self.fits.get(seed) or self.add(seed)

    def _taste(self, prospect: Prospect) -> list[Look]:
        """A few iterations from each start."""
        self.progress(prospect.explanation.label)
        fits = (prospect.search.fit(prospect.explanation, start, TASTE) for start in prospect.starts)
        return [Look(prospect, start, fit) for start, fit in zip(prospect.starts, fits, strict=True)]

    def _hopeful(self, tastes: list[Look], size: int) -> list[Look]:
        """Those not far behind the best of their `size`; while nothing accounts for all, a rough cost may mislead."""
        known = self.best_of_size(size)
        best = dict.fromkeys((self.search, self.glance), known.ratio if known else np.inf)
        for taste in tastes:
            best[taste.prospect.search] = min(best[taste.prospect.search], taste.fit.ratio)

        def hopeful(taste: Look) -> bool:
            leading = best[taste.prospect.search]
            spared = taste.prospect.drifts or (taste.prospect.rough and leading > ADEQUATE)
            return spared or taste.fit.ratio < HOPELESS * max(leading, 1.0)

        return [taste for taste in tastes if hopeful(taste)]

    def _look(self, taste: Look) -> Look:
        """A brief fit that goes on from a taste; where the cost is rough, also one that forgives large errors."""
        prospect = taste.prospect
        self.progress(prospect.explanation.label)
        search, explanation = prospect.search, prospect.explanation
        fits = [search.fit(explanation, taste.fit.values, BRIEF - TASTE)]
        if prospect.rough and not adequate(fits[0]):
            forgiving = search.fit(explanation, taste.start, BRIEF, forgiving=True)
            fits.append(search.fit(explanation, forgiving.values, BRIEF))
        best = min(fits, key=lambda fit: fit.ratio)
        return Look(prospect, taste.start, search.dated(best) if prospect.changes else best)

    def _worth_finishing(self, base: Fit, looks: list[Look]) -> list[Fit]:
        """Of `looks`, the best first, those that deserve a whole fit; on an adequate base, what gains noticeably."""
        if adequate(base):
            return [look.fit for look in looks if look.prospect.base.misfit - look.fit.misfit > PROMISING]
        fits = [look.fit for look in looks]
        near = 1.3 * fits[0].ratio if fits else 0.0
        return [
            fit for rank, fit in enumerate(fits) if rank < FINISHED or fit.ratio < near or not fit.explanation.variants
        ]

    def _finish(self, look: Fit) -> Fit:
        self.progress(look.explanation.label)
        return self.add(look.explanation, look.values)

    def _sharpen(self, fit: Fit) -> None:
        """Look a fit over again, once."""
        if fit.explanation not in self._sharp:
            self._sharp.add(fit.explanation)
            self.progress(f"{fit.explanation.label}, once more")
            self.fits[fit.explanation] = polished(self.search, fit)


def explored(data: EvidenceData, nominal: Model, progress: Progress = lambda _: None) -> Exploration:
    """The exploration of `data`, run to its end; where an effect shows only in samples that choose, those train too."""
    exploration = Exploration(data, nominal, progress)
    if overlooks(exploration.run(), exploration.search):
        exploration = Exploration(after_choice(data), nominal, progress)
        exploration.run()
    return exploration


def _deserves_sharpening(fit: Fit, best: Fit) -> bool:
    """Whether the cost of a fit is rough, and it comes near the best without being its equal."""
    return is_rough(fit.explanation) and fit.ratio < COMPARABLE * best.ratio and alike(best) < fit.misfit


def _best_looks(looks: list[Look]) -> list[Look]:
    """The best look at each explanation, the best first."""
    best: dict[Explanation, Look] = {}
    for look in sorted(looks, key=lambda look: look.fit.ratio):
        best.setdefault(look.fit.explanation, look)
    return list(best.values())


def _faded(variant: Variant, fit: Fit, share: float) -> Variant:
    """The effect as `fit` has it, fixed at a share of its strength."""
    declared = EFFECT[variant.effect]
    values = {name: fit.model.values[f"{variant.effect}.{name}"] for name in declared.names}
    scaled = {name: value * (share if name in declared.strength else 1.0) for name, value in values.items()}
    return Variant(variant.effect, (), tuple(scaled.items()))


def _preference(fit: Fit) -> tuple[int, bool, int, float]:
    """Order among explanations that fit alike: least effects, a drift before a change, least numbers, then by fit."""
    explanation = fit.explanation
    return len(explanation.variants), explanation.changed is not None, len(explanation.names), fit.chi2
