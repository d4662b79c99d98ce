"""One topic or column, with its numbers: how much there is of it, in which range, what is missing, what it could be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.inspection.fields import Field
from pierburg_ros.recording.inspection.guesses import Guess
from pierburg_ros.recording.loss import Span

Guesses = Mapping[Field, "Guess | None"]
"""Every number in a file, and what it could be."""


@dataclass(frozen=True)
class FieldContent:
    """One number of a topic, by its path (empty for a column): its range and what it could be.

    Of topics that are not a plain number, some of the messages are looked at, evenly over the recording.
    """

    path: str
    minimum: float | None
    maximum: float | None
    could_be: str | None


@dataclass(frozen=True)
class TopicContent:
    """One topic or column: how much there is of it, in which range, and what is missing.

    `rate` is the median one [1/s] by log time; `minimum` and `maximum` are those of the value where it is a number;
    `lost` is None where messages have no numbers of their own; `pauses` [s] count from the first message of the file.
    """

    name: str
    type: str
    count: int
    rate: float | None
    minimum: float | None
    maximum: float | None
    lost: int | None
    pauses: tuple[Span, ...]
    clocks: tuple[str, ...]
    read_as: str | None
    fields: tuple[FieldContent, ...]

    def as_mapping(self) -> dict[str, Any]:
        """What `pierburg inspect --json` prints of it."""
        return {**self.__dict__, "fields": [field.__dict__ for field in self.fields]}


def contents_of(fields: Sequence[Field], guessed: Mapping[Field, Guess | None]) -> tuple[FieldContent, ...]:
    """Ranges of some numbers, and what each could be."""
    found = []
    for field in fields:
        low, high = field.limits or (None, None)
        found.append(FieldContent(field.path, low, high, str(guessed[field]) if guessed[field] else None))
    return tuple(found)


def rate(time: Signal) -> float | None:
    """One over the median interval [1/s], where there is one."""
    interval = float(np.median(np.diff(time))) if time.size > 1 else 0.0
    return 1.0 / interval if interval > 0.0 else None
