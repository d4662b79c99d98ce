"""The exploration of explanations, from the smallest up: what else could be the case, and how well would it fit?"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from pierburg_ros.diagnosis.evidence_data import EvidenceData
from pierburg_ros.diagnosis.explanation import Explanation, Variant, quantities, without
from pierburg_ros.diagnosis.hypotheses import ROUGH, Start, is_rough, starts_of
from pierburg_ros.diagnosis.polish import polished
from pierburg_ros.diagnosis.search import Fit, Search, repetition
from pierburg_ros.diagnosis.significance import SIGNIFICANT, accounts_for_all, betters
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model

Progress = Callable[[str], None]
Growth = str | tuple[Variant, list[Start]]
"""What an explanation grows by: a parameter (drifted or changed), or an effect with its starting values."""

ADEQUATE = 1.03
"""Training error over noise up to which an explanation accounts for all there is."""
COMPLETE = 1.01
"""Training error over noise at which the search for explanations of one size ends."""
NEAR = 5.0
"""Training error over noise up to which the best explanation may only have stopped too early."""
RIVALS = 3
"""Explanations of one size that are grown while none is adequate, besides every single drift."""
GLANCE = 24.0
"""How much of a recording [s] a first look takes in."""
LATE = 0.5
"""Excess of squared error in a first look, as a share of the whole, below which the look takes in everything."""
PROMISING = 15.0
"""Gain in chi2 that a first look must promise on top of an adequate explanation to be followed up."""
TIED = 12.0
"""Difference in chi2, in effective samples, below which two explanations of one size are not told apart."""
REFUTED = 1.1
"""Error on the choosing samples, over the least of explanations that fit the training samples alike, from which one is
out."""
BRIEF, FULL = 6, 25
"""Iterations of a first look, and of a whole fit."""
TASTE = 3
"""Iterations of a first look after which a hopeless one ends."""
HOPELESS = 3.0
"""Error over that of the best explanation of the same size from which a first look is hopeless."""
REPLACING = 0.5
"""Share of the error of its base down to which a linear step must promise to come, where another explanation of the
same size accounts for all."""
STARTS_TRIED = 2
"""Starts from which a first look is taken."""
FINISHED = 4
"""How many of the best first looks are always followed by a whole fit."""
SHARPENED = 2
"""How many of the best whole fits with a rough cost are looked over again in each round."""
COMPARABLE = 1.5
"""Training error over that of the best explanation of its size up to which a fit is looked over again."""
FADING = (0.75, 0.5, 0.25, 0.0)
"""Shares of an effect's strength at which what may stand for it is fitted in turn."""
TIMED = frozenset({"external_load", "thermal_resistance"})
"""Effects that may show late: a first look at them takes in the whole recording."""
LARGEST = 3
"""Explanations of more quantities than this are not tried."""


@dataclass(frozen=True)
class Prospect:
    """An explanation to look at, by what it is grown: on which samples, from which starts."""

    explanation: Explanation
    growth: Growth
    search: Search
    starts: tuple[Start, ...]

    @property
    def rough(self) -> bool:
        """Whether the cost has many local minima."""
        return not isinstance(self.growth, str) and self.growth[0].effect in ROUGH

    @property
    def drifts(self) -> bool:
        """Whether it grows by a drift: cheap to look at, and perhaps what others grow on."""
        return self.growth in self.explanation.drifted

    @property
    def changes(self) -> bool:
        """Whether it grows by a change in the middle of the recording."""
        return self.growth == self.explanation.changed


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
        self.data = data
        self.nominal = nominal
        self.fits: dict[Explanation, Fit] = {}
        self._grown: set[Explanation] = set()
        self._sharp: set[Explanation] = set()
        self.progress = progress

    def run(self) -> Fit:
        """Explore until the best explanation cannot be bettered by one more quantity; gives that best one."""
        with threadpool_limits(1):
            best = self.add(Explanation())
            self.grow(Explanation())
            self._sharpened(1)
            best = self.preferred()
            while best.explanation.size < LARGEST and not accounts_for_all(best, self.data):
                for seed in self._promising(best):
                    self.grow(seed)
                    grown = self._sharpened(seed.size + 1)
                    if best.ratio > ADEQUATE and grown is not None and grown.ratio <= COMPLETE:
                        break
                better = self._pruned()
                if better.explanation.size <= best.explanation.size:
                    best = better
                    break
                best = better
            return best

    def add(self, explanation: Explanation, start: Start | None = None, iterations: int = FULL) -> Fit:
        """Fit an explanation and keep it if it is the best of its kind so far."""
        fit = self.search.fit(explanation, start, iterations)
        known = self.fits.get(explanation)
        if known is None or fit.chi2 < known.chi2:
            self.fits[explanation] = fit
        return self.fits[explanation]

    def consider(self, explanation: Explanation, faded: Variant, rival: Fit) -> None:
        """Fit an explanation that stands for an effect of `rival` by other means, if it keeps up as the effect fades.

        In one step the others would have to take over all of it at once, and events would jump; so would they if its
        other effects gave way meanwhile. A load that pushes all the time is a change of preload, and needs no search.
        """
        values = rival.values
        if faded.effect == "external_load" and "spring_preload" in explanation.drifted:
            preload = values["spring_preload"] + values["external_load.torque"]
            self.add(explanation, {**values, "spring_preload": preload})
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

    def preferred(self) -> Fit:
        """The smallest explanation that no larger one betters significantly; of equals, the one with least effects."""
        best = self.best_of_size(0)
        assert best is not None
        for size in range(1, LARGEST + 1):
            larger = self.best_of_size(size)
            if larger is not None and betters(larger, best, self.data):
                best = larger
        return min(self.tied(best, self.of_size(best.explanation.size)), key=_preference)

    def tied(self, best: Fit, among: Iterable[Fit]) -> list[Fit]:
        """Those `among` some fits that the data cannot tell from `best`, itself if it is one of them.

        They fit the training samples alike; one that fails on the choosing samples, where another does not, is out.
        """
        limit = best.chi2 + TIED * repetition(best)
        fits = [fit for fit in among if fit.chi2 <= limit]
        errors = [self.search.choosing_chi2(fit) for fit in fits]
        lowest = min(errors, default=0.0)
        worst = max(REFUTED**2 * lowest, lowest + SIGNIFICANT * repetition(best))
        return [fit for fit, chi2 in zip(fits, errors, strict=True) if chi2 <= worst]

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

    def _sharpened(self, size: int) -> Fit | None:
        """The best explanation of `size`, looked over again where it comes near the noise and does not reach it."""
        best = self.best_of_size(size)
        if best is None or not best.explanation.variants or not ADEQUATE < best.ratio < NEAR:
            return best
        self._sharpen(best)
        return self.best_of_size(size)

    def _promising(self, best: Fit) -> list[Explanation]:
        """Explanations of the size of `best` worth growing: itself, and while nothing is adequate its rivals.

        Single drifts come first: an effect beside a drift is more frequent than two effects, and found sooner.
        """
        size = best.explanation.size
        if best.ratio <= ADEQUATE:
            return [best.explanation]
        rivals = [fit for fit in self.fits.values() if fit.explanation.size == size]
        steady = [fit.chi2 for fit in rivals if fit.explanation.changed is None]
        rivals = [f for f in rivals if f.explanation.changed is None or f.chi2 < 0.5 * min(steady, default=np.inf)]
        rivals.sort(key=lambda fit: fit.chi2)
        alone = [fit.explanation for fit in rivals if not fit.explanation.variants and size == 1]
        return list(dict.fromkeys(alone + [fit.explanation for fit in rivals[:RIVALS]]))

    def grow(self, seed: Explanation) -> None:
        """Fit every explanation that has one quantity more than `seed`."""
        if seed in self._grown:
            return
        self._grown.add(seed)
        base = self.fits.get(seed) or self.add(seed)
        bases = {search: search.linearised(base) for search in (self.search, self.glance)}
        quick = self.search if _shows_late(bases[self.glance], bases[self.search]) else self.glance
        with ThreadPoolExecutor(2) as pool:
            prospects = list(pool.map(lambda task: self._prospect(bases, quick, *task), self._tasks(seed, base)))
            tastes = [taste for tasted in pool.map(self._taste, prospects) for taste in tasted]
            looks = list(pool.map(self._look, self._hopeful(tastes, seed.size + 1)))
            finished = list(pool.map(self._finish, self._worth_finishing(bases, _best_of_each(looks))))
            if bases[self.search].ratio > ADEQUATE:
                list(pool.map(self._sharpen, self._worth_sharpening(finished, seed.size + 1)))

    def _tasks(self, seed: Explanation, base: Fit) -> list[tuple[Explanation, Growth]]:
        """The explanations to try on top of `seed`, each with what is added."""
        grown: list[tuple[Explanation, Growth]] = []
        for name in self.drifts:
            grown.append((Explanation((*seed.drifted, name), seed.variants, seed.changed), name))
            if not seed.variants and seed.changed is None and len(self.data.runs) == 1:
                grown.append((Explanation(seed.drifted, seed.variants, name), name))
        for variant, starts in starts_of(self.data, base.model).items():
            grown.append((seed.plus(variant), (variant, starts)))
        tasks: dict[Explanation, Growth] = {}
        for explanation, growth in grown:
            key = canonical(explanation, self.drifts)
            if key is not None and key not in self.fits:
                tasks.setdefault(key, growth)
        return list(tasks.items())

    def _prospect(self, bases: dict[Search, Fit], quick: Search, explanation: Explanation, growth: Growth) -> Prospect:
        """Where to start looking at a grown explanation: what promises most on top of the base, if anything does."""
        self.progress(label(explanation))
        if isinstance(growth, str):
            if explanation.changed != growth:
                return Prospect(explanation, growth, quick, (bases[quick].values,))
            starts = self.search.change_starts(bases[self.search], growth, STARTS_TRIED)
            return Prospect(explanation, growth, self.search, tuple(starts))
        variant, tried = growth
        search = self.search if variant.effect in TIMED or explanation.changed else quick
        base = bases[search]
        promised = search.screened(base, variant, tried)[:STARTS_TRIED]
        known = self.best_of_size(explanation.size)
        if base.ratio <= ADEQUATE:
            promised = [pair for pair in promised if base.chi2 - pair[0] > PROMISING]
        elif known is not None and known.ratio <= ADEQUATE:
            promised = [pair for pair in promised if pair[0] < REPLACING**2 * base.chi2]
        starts = [{**base.values, **start} for _, start in promised]
        return Prospect(explanation, growth, search, tuple(starts))

    def _taste(self, prospect: Prospect) -> list[Look]:
        """A few iterations from each start."""
        self.progress(label(prospect.explanation))
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
        self.progress(label(prospect.explanation))
        search, explanation = prospect.search, prospect.explanation
        fits = [search.fit(explanation, taste.fit.values, BRIEF - TASTE)]
        if prospect.rough and fits[0].ratio > ADEQUATE:
            forgiving = search.fit(explanation, taste.start, BRIEF, forgiving=True)
            fits.append(search.fit(explanation, forgiving.values, BRIEF))
        best = min(fits, key=lambda fit: fit.ratio)
        return Look(prospect, taste.start, search.dated(best) if prospect.changes else best)

    def _worth_finishing(self, bases: dict[Search, Fit], looks: list[Look]) -> list[Fit]:
        """Looks that deserve a whole fit: the best; on an adequate base only what gains noticeably."""
        if bases[self.search].ratio <= ADEQUATE:
            return [look.fit for look in looks if bases[look.prospect.search].chi2 - look.fit.chi2 > PROMISING]
        fits = sorted((look.fit for look in looks), key=lambda fit: fit.ratio)
        near = 1.3 * fits[0].ratio if fits else 0.0
        return [
            fit for rank, fit in enumerate(fits) if rank < FINISHED or fit.ratio < near or not fit.explanation.variants
        ]

    def _worth_sharpening(self, finished: list[Fit], size: int) -> list[Fit]:
        """Whole fits with a rough cost that come near the best of their `size`."""
        best = self.best_of_size(size)
        rough = [fit for fit in finished if best is not None and _deserves_sharpening(fit, best)]
        return sorted(rough, key=lambda fit: fit.chi2)[:SHARPENED]

    def _finish(self, look: Fit) -> Fit:
        self.progress(label(look.explanation))
        return self.add(look.explanation, look.values)

    def _sharpen(self, fit: Fit) -> None:
        """Look a fit over again, once."""
        if fit.explanation not in self._sharp:
            self._sharp.add(fit.explanation)
            self.progress(f"{label(fit.explanation)}, once more")
            self.fits[fit.explanation] = polished(self.search, fit)


def _deserves_sharpening(fit: Fit, best: Fit) -> bool:
    """Whether the cost of a fit is rough, and it comes near the best."""
    return is_rough(fit.explanation) and fit.ratio < COMPARABLE * best.ratio


def _best_of_each(looks: list[Look]) -> list[Look]:
    """The best look at each explanation."""
    best: dict[Explanation, Look] = {}
    for look in looks:
        known = best.get(look.fit.explanation)
        if known is None or look.fit.ratio < known.fit.ratio:
            best[look.fit.explanation] = look
    return list(best.values())


def _faded(variant: Variant, fit: Fit, share: float) -> Variant:
    """The effect as `fit` has it, fixed at a share of its strength."""
    declared = EFFECT[variant.effect]
    values = {name: fit.model.values[f"{variant.effect}.{name}"] for name in declared.names}
    scaled = {name: value * (share if name in declared.strength else 1.0) for name, value in values.items()}
    return Variant(variant.effect, (), tuple(scaled.items()))


def _shows_late(glance: Fit, whole: Fit) -> bool:
    """Whether the first look would miss most of what is left to explain."""
    return glance.ratio**2 - 1.0 < LATE * (whole.ratio**2 - 1.0)


def _preference(fit: Fit) -> tuple[int, bool, int, float]:
    """Order among explanations that fit alike: least effects, a drift before a change, least numbers, then by fit."""
    explanation = fit.explanation
    return len(explanation.variants), explanation.changed is not None, len(explanation.names), fit.chi2


def drifting(nominal: Model) -> tuple[str, ...]:
    """Names of what may drift: the free base parameters, and the parameters of effects the actuator always has."""
    own = tuple(f"{effect}.{name}" for effect, values in nominal.actuator.effects.items() for name in values)
    return nominal.actuator.free + own


def canonical(explanation: Explanation, order: Sequence[str]) -> Explanation | None:
    """The same explanation in one order; None where a quantity stands twice."""
    drifted = tuple(name for name in order if name in explanation.drifted)
    effects = explanation.effects
    always = {name.split(".")[0] for name in order if "." in name}
    if len(drifted) < len(explanation.drifted) or len(set(effects)) < len(effects) or always & set(effects):
        return None
    if explanation.changed in drifted:
        return None
    variants = tuple(sorted(explanation.variants, key=lambda variant: variant.effect))
    return Explanation(drifted, variants, explanation.changed)


def label(explanation: Explanation) -> str:
    """For people: what changes."""
    change = (f"change of {explanation.changed}",) if explanation.changed else ()
    return " + ".join((*explanation.drifted, *change, *(v.label for v in explanation.variants))) or "nominal"
