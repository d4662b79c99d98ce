"""What the ways of making time ask of whatever ticks."""

from __future__ import annotations

from threading import Event
from typing import Any, Protocol

from pierburg_ros.nodes.core.pacing import Pacer
from pierburg_ros.nodes.core.sampled_plant import Sample


class Waiting(Protocol):
    """What may hold the source of simulated time back."""

    def wait(self, now: int, period: int) -> bool:
        """Return when the tick at `now` [ns], ticks being `period` [ns] apart, may be followed; whether it waited."""


class Ticking(Protocol):
    """A sampled plant on a graph: ticks at given times and publishes what a tick gives."""

    stopping: Event
    pacer: Pacer
    values: dict[str, Any]
    held_back: Waiting | None
    """None where the plant is not the source of time."""

    def now(self) -> int:
        """What the clock says [ns]."""

    def follows(self, time: int) -> bool:
        """Whether `time` [ns] lies after the last tick."""

    def tick(self, time: int) -> Sample:
        """One tick at `time` [ns]."""

    def publish(self, sample: Sample, with_clock: bool = False) -> None:
        """Send out what a tick gave, with the time if this is its source."""
