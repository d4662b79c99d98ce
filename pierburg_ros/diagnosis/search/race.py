"""A race of prospects: all get a few iterations, those not far behind some more, the best a whole fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.diagnosis.search.linear import redated
from pierburg_ros.diagnosis.search.screening import Prospect
from pierburg_ros.diagnosis.search.selection import ADEQUATE, PROMISING, adequate
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation

ROUNDS = 6
"""Iterations after which the best are chosen for a whole fit; after half of them those far behind fall out. Work: most
of a search is spent on them; not varied."""
BEHIND = 3.0
"""Error over that of the best explanation of the same size from which a prospect is far behind. Measured: with it 22
of n = 22 practice recordings keep their verdict; other values were not tried."""
NEAR = 1.3
"""Error over that of the best prospect up to which one gets a whole fit, besides the best few. Work: a larger value
costs whole fits; not varied."""
FINISHED = 4
"""How many of the best get a whole fit in any case. Work: each is a whole fit; not varied."""


@dataclass(frozen=True)
class Look:
    """A brief fit of a prospect from one of its starts."""

    prospect: Prospect
    start: dict[str, float]
    fit: Fit


def winners(
    prospects: Sequence[Prospect],
    best: Mapping[Estimator, float],
    pool: Executor,
    progress: Callable[[str], None],
    most: int | None = None,
) -> list[Fit]:
    """Brief fits of the prospects that deserve a whole one, the best first.

    `best` is the error over noise of the best explanation of the same size known, by the samples it was fitted to.
    `most` ends the second round with so many.
    """
    firsts = [look for looks in pool.map(lambda each: _first(each, progress), prospects) for look in looks]
    kept = _not_behind(firsts, best)
    if most is not None:
        kept = _best_of_each(kept)[:most]
    looks = _best_of_each(list(pool.map(lambda look: _second(look, progress), kept)))
    nearest = looks[0].fit.ratio if looks else 0.0
    return [look.fit for rank, look in enumerate(looks) if _deserves_whole_fit(look, rank, nearest)]


def _first(prospect: Prospect, progress: Callable[[str], None]) -> list[Look]:
    progress(prospect.explanation.label)
    fits = (prospect.estimator.fit(prospect.explanation, start, ROUNDS // 2) for start in prospect.starts)
    return [Look(prospect, start, fit) for start, fit in zip(prospect.starts, fits, strict=True)]


def _second(look: Look, progress: Callable[[str], None]) -> Look:
    """The look carried on; where events jump, also a fit that forgives large errors."""
    prospect, explanation = look.prospect, look.prospect.explanation
    progress(explanation.label)
    estimator = prospect.estimator
    fits = [estimator.fit(explanation, look.fit.values, ROUNDS // 2)]
    if prospect.jumps and not adequate(fits[0]):
        forgiving = estimator.fit(explanation, look.start, ROUNDS, forgiving=True)
        fits.append(estimator.fit(explanation, forgiving.values, ROUNDS))
    best = min(fits, key=lambda fit: fit.ratio)
    return replace(look, fit=redated(estimator, best) if prospect.changes else best)


def _not_behind(looks: Sequence[Look], best: Mapping[Estimator, float]) -> list[Look]:
    """Those not far behind; drifts stay, and what jumps stays while nothing accounts for all: its cost may mislead."""
    leading = dict(best)
    for look in looks:
        estimator = look.prospect.estimator
        leading[estimator] = min(leading.get(estimator, np.inf), look.fit.ratio)

    def stays(look: Look) -> bool:
        ahead = leading[look.prospect.estimator]
        spared = look.prospect.drifts or (look.prospect.jumps and ahead > ADEQUATE)
        return spared or look.fit.ratio < BEHIND * max(ahead, 1.0)

    return [look for look in looks if stays(look)]


def _best_of_each(looks: Sequence[Look]) -> list[Look]:
    """The best look at each explanation, the best first."""
    best: dict[Explanation, Look] = {}
    for look in sorted(looks, key=lambda look: look.fit.ratio):
        best.setdefault(look.fit.explanation, look)
    return list(best.values())


def _deserves_whole_fit(look: Look, rank: int, nearest: float) -> bool:
    """On top of what accounts for all, what gains noticeably; otherwise the best few, what is near them, drifts."""
    base = look.prospect.base
    if adequate(base):
        return bool(base.misfit - look.fit.misfit > PROMISING)
    return rank < FINISHED or look.fit.ratio < NEAR * nearest or not look.fit.explanation.variants
