"""What is in a recording: every topic with its numbers, and the recording as the other commands read it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.intake import reading
from pierburg_ros.recording.clocks import is_headed
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.formats import cdr, format_of
from pierburg_ros.recording.formats.messages import Bag, Messages
from pierburg_ros.recording.inspection.draft import draft
from pierburg_ros.recording.inspection.fields import Field, fields_of
from pierburg_ros.recording.inspection.guesses import Guess, guess
from pierburg_ros.recording.inspection.table_time import TimeGuess, time_guess
from pierburg_ros.recording.loss import Span, are_numbered, numbered_loss, pauses
from pierburg_ros.recording.read import read_recording
from pierburg_ros.recording.recording import Recording
from pierburg_ros.recording.signal_map import SignalMap, signal_map
from pierburg_ros.recording.signals import SIGNALS, TIME, last_name

COLUMN = "column"
"""Type of what a CSV has in place of topics."""


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


@dataclass(frozen=True)
class Inspection:
    """The topics of a file, and the recording that they make or the reason why they make none.

    `signals` is the text of a signal map to edit, made of what each number could be.
    """

    name: str
    topics: tuple[TopicContent, ...]
    recording: Recording | None
    problem: str
    signals: str

    def as_mapping(self) -> dict[str, Any]:
        """What `pierburg inspect --json` prints."""
        return {
            "schema": 1,
            "recording": self.name,
            "topics": [topic.as_mapping() for topic in self.topics],
            "read_as": None if self.recording is None else summary(self.recording),
            "problem": self.problem or None,
        }


def inspect(
    path: Path,
    *,
    time: str | None = None,
    topics: Mapping[str, str] | None = None,
    signals: str | Path | SignalMap | None = None,
) -> Inspection:
    """The content of the recording at `path`; `time`, `topics` and `signals` choose as in `read_recording`."""
    chosen = signal_map(signals, topics or {})
    recording, problem = None, ""
    try:
        recording = read_recording(path, time=time, signals=chosen)
    except InputError as error:
        if not path.exists():
            raise
        problem = str(error)
    with reading(path, "a recording"), np.errstate(all="ignore"):
        found = format_of(path).read(path, lambda _: True)
        clock = time_guess(numbers_of(found)) if isinstance(found, Columns) else None
        guessed = guesses(found, clock)
        contents = (
            columns(found, chosen, clock, guessed) if isinstance(found, Columns) else messages(found, chosen, guessed)
        )
    text = draft(path.name, (each for each in guessed.values() if each), clock, isinstance(found, Columns))
    return Inspection(path.name, contents, recording, problem, text)


def guesses(found: Bag | Columns, clock: TimeGuess | None) -> dict[Field, Guess | None]:
    """Every number in a file, by topic and path or by column, and what it could be."""
    if isinstance(found, Columns):
        times = clock.columns if clock else ()
        numbers = [Field(name, COLUMN, "", values[np.isfinite(values)]) for name, values in numbers_of(found).items()]
        return {field: None if field.name in times else guess(field) for field in numbers}
    return {field: guess(field) for topic in sorted(found.types) for field in fields_of(found.messages(topic))}


def numbers_of(table: Columns) -> dict[str, Signal]:
    """The columns of a table, also those with cells that are no numbers."""
    return {name: np.frombuffer(values, np.float64) for name, values in table.cells.items()}


def summary(recording: Recording) -> dict[str, Any]:
    """The recording as the other commands see it."""
    return {
        "quantity": recording.quantity,
        "unit": recording.unit,
        "samples": int(recording.time.size),
        "duration": recording.duration,
        "time_source": recording.time_source,
        "losses": [
            {"signal": loss.signal, "lost": loss.lost, "sent": loss.sent, "spans": loss.spans}
            for loss in recording.losses
        ],
        "unknown_input": recording.unknown_input,
    }


def messages(bag: Bag, chosen: SignalMap, guessed: Mapping[Field, Guess | None]) -> tuple[TopicContent, ...]:
    """The topics of a file or folder."""
    found = {topic: bag.messages(topic) for topic in sorted(bag.types)}
    first = min((int(each.log_time[0]) for each in found.values() if len(each)), default=0)
    fields = {topic: [field for field in guessed if field.name == topic] for topic in found}
    return tuple(
        topic_content(each, first, used_as(each, chosen), contents_of(fields[topic], guessed), fields[topic])
        for topic, each in found.items()
    )


def topic_content(
    found: Messages, first: int, read_as: str | None, contents: tuple[FieldContent, ...], fields: Sequence[Field]
) -> TopicContent:
    """What the messages of one topic are; times count from `first` [ns]."""
    time: Signal = (found.log_time - first).astype(np.float64) * 1e-9
    lost = numbered_loss(found.topic, time, found.sequence) if are_numbered(found.sequence) else None
    only = fields[0].limits if len(fields) == 1 else None
    return TopicContent(
        found.topic,
        found.type,
        len(found),
        rate(time),
        only[0] if only else None,
        only[1] if only else None,
        None if lost is None else lost.lost,
        pauses(time) if lost is None else lost.spans,
        clocks(found),
        read_as,
        contents,
    )


def contents_of(fields: Sequence[Field], guessed: Mapping[Field, Guess | None]) -> tuple[FieldContent, ...]:
    """Ranges of some numbers, and what each could be."""
    found = []
    for field in fields:
        low, high = field.limits or (None, None)
        found.append(FieldContent(field.path, low, high, str(guessed[field]) if guessed[field] else None))
    return tuple(found)


def used_as(found: Messages, chosen: SignalMap) -> str | None:
    """The signals that a topic is read as: as a person chose, or by its own name and type."""
    signals = [signal for signal, source in chosen.sources.items() if source.name == found.topic]
    name = last_name(found.topic)
    usual = [signal for signal, each in SIGNALS.items() if each.topics.get(name) == found.type]
    free = [signal for signal in usual if signal not in chosen.sources and signal not in chosen.left_out]
    clock = ["clock"] if (name, found.type) == ("clock", cdr.CLOCK) else []
    return ", ".join([*signals, *free, *clock]) or None


def columns(
    table: Columns, chosen: SignalMap, clock: TimeGuess | None, guessed: Mapping[Field, Guess | None]
) -> tuple[TopicContent, ...]:
    """The columns of a table."""
    cells = numbers_of(table)
    seconds = clock.seconds if clock else np.zeros(0)
    called = {column: signal for signal, column in chosen.columns.items()}
    called |= dict.fromkeys(chosen.time.columns if chosen.time else (TIME,), TIME)
    found = []
    for field in guessed:
        filled = np.isfinite(cells[field.name])
        time = seconds[filled] if seconds.size == filled.size else np.zeros(0)
        low, high = field.limits or (None, None)
        found.append(
            TopicContent(
                field.name,
                COLUMN,
                int(np.count_nonzero(filled)),
                rate(time),
                low,
                high,
                None,
                pauses(time - time[0]) if time.size else (),
                (COLUMN,),
                called.get(field.name),
                contents_of([field], guessed),
            )
        )
    return tuple(found)


def rate(time: Signal) -> float | None:
    """One over the median interval [1/s], where there is one."""
    interval = float(np.median(np.diff(time))) if time.size > 1 else 0.0
    return 1.0 / interval if interval > 0.0 else None


def clocks(found: Messages) -> tuple[str, ...]:
    """The clocks that the messages themselves carry."""
    has = {
        "stamp": is_headed(found) and all(found.data) and bool(np.any(cdr.stamp(found))),
        "publish": bool(np.any(found.publish_time)),
        "log": bool(np.any(found.log_time)),
    }
    return tuple(name for name, is_there in has.items() if is_there)
