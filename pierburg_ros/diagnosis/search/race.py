"""A race of candidates: all get a few iterations, those not far behind some more, and the best a full fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.diagnosis.search.linear import redated
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.diagnosis.search.selection import PROMISING
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.inference.explanation import Explanation

ROUNDS = 4
"""Number of iterations after which the best are chosen for a full fit; after half of them, those far behind drop out.
Measured: of n = 148 descents to effects, 137 end within 2 % of the lowest after 2 iterations, 142 after 3, 143 after 4
and 144 after 6. They take 1,562, 1,837, 1,977 and 2,113 simulations."""
BEHIND = 3.0
"""Ratio of a candidate's error to that of the best explanation of the same size, from which it is far behind. Measured:
with it, 22 of n = 22 practice recordings keep their verdict; other values were not tried."""
NEAR = 1.3
"""Ratio of a candidate's error to that of the best candidate, up to which it gets a full fit besides the best few, and
its change is dated again. Work: a larger value costs full fits; not varied. The true change led before it was dated
again (n = 4)."""
FINISHED = 4
"""Number of the best candidates that get a full fit in any case. Work: each is a full fit; not varied."""


@dataclass(frozen=True)
class Entry:
    """A candidate in the race: one of its starts, and the fit reached from it."""

    candidate: Candidate
    start: dict[str, float]
    fit: Fit


def winners(
    candidates: Sequence[Candidate],
    best: Mapping[Estimator, float],
    pool: Executor,
    progress: Callable[[str], None],
    most: int | None = None,
) -> list[Fit]:
    """Brief fits of the candidates that deserve a full fit, the best first.

    `best` is, for each estimator, the error over noise of the best known explanation of the same size. At most `most`
    entries go into the second round. After it, changes near the best get their time searched again, unless the best is
    adequate.
    """
    firsts = [entry for entries in pool.map(lambda each: _first(each, progress), candidates) for entry in entries]
    kept = _not_behind(firsts, best)
    if most is not None:
        kept = _best_of_each(kept)[:most]
    entries = _best_of_each(list(pool.map(lambda entry: _second(entry, progress), kept)))
    if entries and not adequate(entries[0].fit):
        near = NEAR * entries[0].fit.ratio
        entries = _best_of_each(list(pool.map(lambda entry: _dated(entry, near), entries)))
    nearest = entries[0].fit.ratio if entries else 0.0
    return [entry.fit for rank, entry in enumerate(entries) if _deserves_whole_fit(entry, rank, nearest)]


def _first(candidate: Candidate, progress: Callable[[str], None]) -> list[Entry]:
    progress(candidate.explanation.label)
    fits = (candidate.estimator.fit(candidate.explanation, start, ROUNDS // 2) for start in candidate.starts)
    return [Entry(candidate, start, fit) for start, fit in zip(candidate.starts, fits, strict=True)]


def _second(entry: Entry, progress: Callable[[str], None]) -> Entry:
    """The entry after more iterations; where the cost has many local minima, also by way of a fit between rests.

    That way is tried if the entry is not adequate. The fit between rests forgives large errors.
    """
    candidate, explanation = entry.candidate, entry.candidate.explanation
    progress(explanation.label)
    estimator = candidate.estimator
    fits = [estimator.fit(explanation, entry.fit.values, ROUNDS // 2)]
    if candidate.jumps and not adequate(fits[0]):
        smooth = estimator.between_rests.fit(explanation, entry.start, ROUNDS, forgiving=True)
        fits.append(estimator.fit(explanation, smooth.values, ROUNDS))
    return replace(entry, fit=min(fits, key=lambda fit: fit.ratio))


def _dated(entry: Entry, near: float) -> Entry:
    """The entry with the time of its change searched again, if it has a change and an error below `near`."""
    if not entry.candidate.changes or entry.fit.ratio >= near:
        return entry
    return replace(entry, fit=redated(entry.candidate.estimator, entry.fit))


def _not_behind(entries: Sequence[Entry], best: Mapping[Estimator, float]) -> list[Entry]:
    """The entries that are not far behind.

    Drifts stay. Entries with many local minima stay too, as long as the leading error is above `EXPLAINED`: their cost
    may mislead.
    """
    leading = dict(best)
    for entry in entries:
        estimator = entry.candidate.estimator
        leading[estimator] = min(leading.get(estimator, np.inf), entry.fit.ratio)

    def stays(entry: Entry) -> bool:
        ahead = leading[entry.candidate.estimator]
        spared = entry.candidate.drifts or (entry.candidate.jumps and ahead > EXPLAINED)
        return spared or entry.fit.ratio < BEHIND * max(ahead, 1.0)

    return [entry for entry in entries if stays(entry)]


def _best_of_each(entries: Sequence[Entry]) -> list[Entry]:
    """The best entry of each explanation, the best first."""
    best: dict[Explanation, Entry] = {}
    for entry in sorted(entries, key=lambda entry: entry.fit.ratio):
        best.setdefault(entry.fit.explanation, entry)
    return list(best.values())


def _deserves_whole_fit(entry: Entry, rank: int, nearest: float) -> bool:
    """Whether an entry gets a full fit.

    On an adequate base, it must gain noticeably. Otherwise the best few do, those near the best, and those without
    effects.
    """
    base = entry.candidate.base
    if adequate(base):
        return bool(base.misfit - entry.fit.misfit > PROMISING)
    return rank < FINISHED or entry.fit.ratio < NEAR * nearest or not entry.fit.explanation.variants
