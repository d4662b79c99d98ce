"""Which trials a run consists of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from pierburg_ros.errors import InputError, near
from pierburg_ros.proof.concealment import (
    DIRTY,
    OVER_GRAPH,
    PUBLISHED,
    draw,
    draw_dirty,
    draw_over_graph,
    schedule,
)
from pierburg_ros.proof.trial import Trial


@dataclass(frozen=True)
class Plan:
    """Trials of each kind, drawn from one seed, recorded in one process or over the ROS graph, clean or dirty."""

    counts: Mapping[str, int]
    seed: int
    over_graph: bool = False
    dirty: bool = False

    @property
    def size(self) -> int:
        """Number of trials."""
        return sum(self.counts.values())

    @property
    def names(self) -> list[tuple[str, int]]:
        """Kind and number of every trial, in the order in which they are begun."""
        return schedule(self.counts)

    def trial(self, kind: str, number: int) -> Trial:
        """One of the trials."""
        drawn = draw_over_graph if self.over_graph else draw_dirty if self.dirty else draw
        return drawn(kind, number, self.seed)


def planned(
    seed: int, trials: int | None = None, only: Sequence[str] = (), over_graph: bool = False, dirty: bool = False
) -> Plan:
    """The published run, or `trials` of each kind; `only` some kinds. A dirty run has kinds of dirt."""
    if over_graph and dirty:
        raise InputError("found a dirty run over the graph, expected one of the two. Leave one option out.")
    published = OVER_GRAPH if over_graph else DIRTY if dirty else PUBLISHED
    for kind in only:
        if kind not in published:
            raise InputError(f"found kind {kind!r}, expected one of {', '.join(published)}.{near(kind, published)}")
    chosen = {kind: count for kind, count in published.items() if not only or kind in only}
    return Plan(chosen if trials is None else dict.fromkeys(chosen, trials), seed, over_graph, dirty)
