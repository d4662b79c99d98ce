"""The located windows for people: neighbours are merged, and the largest share of the mismatch comes first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pierburg_ros.diagnosis.schema import Location

MERGED_WINDOWS = 0.005
"""Windows apart by less than this share of the time from the first to the last are merged. Chosen: on a plot as wide as
a page they touch."""


@dataclass(frozen=True)
class Place:
    """A window [s] with its share of the mismatch and the regime of the shaft there."""

    start: float
    end: float
    share: float
    regime: str


def places(locations: Sequence[Location]) -> list[Place]:
    """The windows with neighbours merged, sorted by their share; a merged window has the regime of its largest part."""
    merged: list[list[Location]] = []
    ends = [moment for each in locations for moment in (each.start, each.end)]
    apart = MERGED_WINDOWS * (max(ends) - min(ends)) if ends else 0.0
    for each in sorted(locations, key=lambda place: place.start):
        if merged and each.start - merged[-1][-1].end < apart:
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
