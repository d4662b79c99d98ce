"""The located windows as a person looks for them: neighbours as one, the most of the mismatch first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pierburg_ros.diagnosis.schema import Location

APART = 0.3
"""Windows less than this apart [s] are shown as one. Chosen: on a plot of a minute they touch."""


@dataclass(frozen=True)
class Place:
    """A window [s] with its share of the mismatch and what the shaft does there."""

    start: float
    end: float
    share: float
    regime: str


def places(locations: Sequence[Location]) -> list[Place]:
    """The windows with neighbours merged, sorted by their share; what the larger part does is said of the whole."""
    merged: list[list[Location]] = []
    for each in sorted(locations, key=lambda place: place.start):
        if merged and each.start - merged[-1][-1].end < APART:
            merged[-1].append(each)
        else:
            merged.append([each])
    found = [
        Place(
            group[0].start,
            group[-1].end,
            sum(each.share for each in group),
            max(group, key=lambda each: each.share).regime,
        )
        for group in merged
    ]
    return sorted(found, key=lambda place: -place.share)
