"""A race of candidates: all get a few iterations, those not far behind some more, the best a whole fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.diagnosis.search.linear import redated
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.diagnosis.search.selection import PROMISING, adequate
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation
from pierburg_ros.estimation.likelihood import EXPLAINED

ROUNDS = 4
"""Iterations after which the best are chosen for a whole fit; after half of them those far behind fall out. Measured:
over n = 148 descents to effects 137 end within 2 % of the lowest after 2, 142 after 3, 143 after 4 and 144 after 6,
with 1,562, 1,837, 1,977 and 2,113 simulations."""
BEHIND = 3.0
"""Error over that of the best explanation of the same size from which a candidate is far behind. Measured: with it 22
of n = 22 practice recordings keep their verdict; other values were not tried."""
NEAR = 1.3
"""Error over that of the best candidate up to which one gets a whole fit, besides the best few, and a change is dated
anew. Work: a larger value costs whole fits; not varied. The change that was there led before it was dated (n = 4)."""
FINISHED = 4
"""How many of the best get a whole fit in any case. Work: each is a whole fit; not varied."""


@dataclass(frozen=True)
class Entry:
    """A candidate in the race: one of its starts, and the fit that it has come to."""

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
    """Brief fits of the candidates that deserve a whole one, the best first.

    `best` is the error over noise of the best explanation of the same size known, by the samples it was fitted to.
    `most` ends the second round with so many. Of changes those near the best are then dated anew, unless it accounts
    for all.
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
    """The entry carried on; where events jump, also one that has come between rests first, large errors forgiven."""
    candidate, explanation = entry.candidate, entry.candidate.explanation
    progress(explanation.label)
    estimator = candidate.estimator
    fits = [estimator.fit(explanation, entry.fit.values, ROUNDS // 2)]
    if candidate.jumps and not adequate(fits[0]):
        smooth = estimator.between_rests.fit(explanation, entry.start, ROUNDS, forgiving=True)
        fits.append(estimator.fit(explanation, smooth.values, ROUNDS))
    return replace(entry, fit=min(fits, key=lambda fit: fit.ratio))


def _dated(entry: Entry, near: float) -> Entry:
    """The entry with the moment of its change, if it has one and an error below `near`, looked for around it."""
    if not entry.candidate.changes or entry.fit.ratio >= near:
        return entry
    return replace(entry, fit=redated(entry.candidate.estimator, entry.fit))


def _not_behind(entries: Sequence[Entry], best: Mapping[Estimator, float]) -> list[Entry]:
    """Those not far behind. Drifts stay; so does what jumps while nothing accounts for all: its cost may mislead."""
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
    """Beyond what accounts for all: what gains noticeably. Otherwise: the best few, what is near them, and drifts."""
    base = entry.candidate.base
    if adequate(base):
        return bool(base.misfit - entry.fit.misfit > PROMISING)
    return rank < FINISHED or entry.fit.ratio < NEAR * nearest or not entry.fit.explanation.variants
