"""What may be added to an explanation, and how far a linear step along it promises to come."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.diagnosis.search.candidates import ROUGH, TIMED, starts_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant, canonical
from pierburg_ros.diagnosis.search.fits import Fit, Search
from pierburg_ros.diagnosis.search.selection import adequate
from pierburg_ros.effects.effect import Start

Growth = str | tuple[Variant, Sequence[Start]]
"""What an explanation grows by: a parameter (drifted or changed), or an effect with its starting values."""

LATE = 0.5
"""Excess of squared error in a first look, as a share of the whole, below which the look takes in everything."""
PROMISING = 15.0
"""Gain in chi2 that a first look must promise on top of an adequate explanation to be followed up."""
STARTS_TRIED = 2
"""Starts from which a first look is taken."""


@dataclass(frozen=True)
class Prospect:
    """An explanation to look at, by what it is grown: on which samples, from which starts.

    `base` is the explanation that it grows on, on the same samples, `promise` the error over noise that a linear step
    from there comes to, infinite where none was made.
    """

    explanation: Explanation
    growth: Growth
    search: Search
    base: Fit
    starts: tuple[Start, ...]
    promise: float = np.inf

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


class Outlook:
    """Looks from an explanation to those with one quantity more, on all samples and on those of a glance."""

    def __init__(
        self, search: Search, glance: Search, drifts: tuple[str, ...], progress: Callable[[str], None]
    ) -> None:
        self.search, self.glance = search, glance
        self.drifts = drifts
        self.progress = progress
        self._seen: dict[Explanation, tuple[Fit, list[Prospect]]] = {}

    def on(self, fit: Fit, known: Container[Explanation], pool: Executor) -> list[Prospect]:
        """What may be added to the explanation of `fit` besides what is `known`; looked for once while `fit` stands."""
        base, prospects = self._seen.get(fit.explanation, (None, []))
        if base is not fit:
            prospects = self._from(fit, known, pool)
            self._seen[fit.explanation] = fit, prospects
        return [prospect for prospect in prospects if prospect.explanation not in known]

    def _from(self, fit: Fit, known: Container[Explanation], pool: Executor) -> list[Prospect]:
        """What may be added to `fit`, with its promise: at a glance, unless what it leaves shows late."""
        seed = fit.explanation
        whole = self.search.linearised(fit)
        glance = self.glance.linearised(whole)
        quick = (self.search, whole) if _shows_late(glance, whole) else (self.glance, glance)

        def prospect(task: tuple[Explanation, Growth]) -> Prospect:
            explanation, growth = task
            self.progress(explanation.label)
            if explanation.changed != seed.changed:
                return self._changing(explanation, whole)
            if isinstance(growth, str):
                return self._drifting(explanation, growth, *quick)
            slow = growth[0].effect in TIMED or explanation.changed
            return self._acting(explanation, growth, *((self.search, whole) if slow else quick))

        return list(pool.map(prospect, self._tasks(whole, known)))

    def _tasks(self, base: Fit, known: Container[Explanation]) -> list[tuple[Explanation, Growth]]:
        """The explanations to try on top of `base`, each with what is added."""
        seed, data = base.explanation, self.search.data
        grown: list[tuple[Explanation, Growth]] = []
        for name in self.drifts:
            grown.append((Explanation((*seed.drifted, name), seed.variants, seed.changed), name))
            if not seed.variants and seed.changed is None and len(data.runs) == 1:
                grown.append((Explanation(seed.drifted, seed.variants, name), name))
        for variant, starts in starts_of(data, base.model).items():
            grown.append((seed.plus(variant), (variant, starts)))
        tasks: dict[Explanation, Growth] = {}
        for explanation, growth in grown:
            key = canonical(explanation, self.drifts)
            if key is not None and key not in known:
                tasks.setdefault(key, growth)
        return list(tasks.items())

    def _changing(self, explanation: Explanation, base: Fit) -> Prospect:
        """A change in the middle of the recording on top of `base`, at the moments that gain most."""
        name = explanation.changed
        assert name is not None
        starts = self.search.change_starts(base, name, STARTS_TRIED)
        return Prospect(explanation, name, self.search, base, tuple(starts))

    def _drifting(self, explanation: Explanation, name: str, search: Search, base: Fit) -> Prospect:
        """One more drift on top of `base`."""
        probe = search.fit(explanation, base.values, 0)
        return Prospect(explanation, name, search, base, (base.values,), _error(search.stepped(probe), base))

    def _acting(
        self, explanation: Explanation, growth: tuple[Variant, Sequence[Start]], search: Search, base: Fit
    ) -> Prospect:
        """One more effect on top of `base`, from the starts that promise most, if any does."""
        promised = search.screened(base, *growth)[:STARTS_TRIED]
        if adequate(base):
            promised = [pair for pair in promised if base.chi2 - pair[0] > PROMISING]
        starts = [{**base.values, **start} for _, start in promised]
        promise = min((chi2 for chi2, _ in promised), default=np.inf)
        return Prospect(explanation, growth, search, base, tuple(starts), _error(promise, base))


def most_promising(prospects: list[Prospect], most: int) -> list[Prospect]:
    """The first so many by what a linear step promises."""
    return sorted(prospects, key=lambda prospect: prospect.promise)[:most]


def _error(chi2: float, fit: Fit) -> float:
    """Error over noise that a sum of squares on the samples of `fit` amounts to."""
    return float(np.sqrt(chi2 / fit.solution.residual.size))


def _shows_late(glance: Fit, whole: Fit) -> bool:
    """Whether the first look would miss most of what is left to explain."""
    return glance.ratio**2 - 1.0 < LATE * (whole.ratio**2 - 1.0)
