"""What is in a recording: every topic with its numbers, and the recording as the other commands read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.intake import reading
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.formats import cdr, format_of
from pierburg_ros.recording.formats.messages import Bag, Messages
from pierburg_ros.recording.loss import Span, are_numbered, numbered_loss, pauses
from pierburg_ros.recording.read import DECODERS, read_recording
from pierburg_ros.recording.recording import Recording
from pierburg_ros.recording.roles import ROLES, last_name

COLUMN = "column"
"""Type of what a CSV has in place of topics."""


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


@dataclass(frozen=True)
class Inspection:
    """The topics of a file, and the recording that they make or the reason why they make none."""

    name: str
    topics: tuple[TopicContent, ...]
    recording: Recording | None
    problem: str

    def as_mapping(self) -> dict[str, Any]:
        """What `pierburg inspect --json` prints."""
        return {
            "schema": 1,
            "recording": self.name,
            "topics": [topic.__dict__ for topic in self.topics],
            "read_as": None if self.recording is None else summary(self.recording),
            "problem": self.problem or None,
        }


def inspect(path: Path, *, time: str | None = None, topics: Mapping[str, str] | None = None) -> Inspection:
    """The content of the recording at `path`; `time` and `topics` choose as in `read_recording`."""
    recording, problem = None, ""
    try:
        recording = read_recording(path, time=time, topics=topics)
    except InputError as error:
        if not path.exists():
            raise
        problem = str(error)
    named = {name: signal for signal, name in (topics or {}).items()}
    with reading(path, "a recording"):
        found = format_of(path).read(path, lambda _: True)
    contents = columns(found) if isinstance(found, Columns) else messages(found, named)
    return Inspection(path.name, contents, recording, problem)


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


def messages(bag: Bag, named: Mapping[str, str]) -> tuple[TopicContent, ...]:
    """The topics of a file or folder; `named` has the signal of some topics."""
    found = {topic: bag.messages(topic) for topic in sorted(bag.types)}
    first = min((int(each.log_time[0]) for each in found.values() if len(each)), default=0)
    return tuple(topic_content(each, first, named) for each in found.values())


def topic_content(found: Messages, first: int, named: Mapping[str, str]) -> TopicContent:
    """What the messages of one topic are; times count from `first` [ns]."""
    time: Signal = (found.log_time - first).astype(np.float64) * 1e-9
    sparse = found.type not in DECODERS
    values = np.zeros(0) if sparse else DECODERS[found.type](found)
    lost = numbered_loss(found.topic, time, found.sequence) if are_numbered(found.sequence) else None
    role = named.get(found.topic, last_name(found.topic))
    fits = ROLES.get(role) == found.type
    return TopicContent(
        found.topic,
        found.type,
        len(found),
        rate(time),
        *limits(values),
        None if lost is None else lost.lost,
        pauses(time) if lost is None else lost.spans,
        clocks(found),
        role if fits else None,
    )


def columns(table: Columns) -> tuple[TopicContent, ...]:
    """The columns of a table."""
    cells = {name: np.frombuffer(values, np.float64) for name, values in table.cells.items()}
    times = cells.get("time", np.zeros(0))
    found = []
    for name, values in cells.items():
        filled = np.isfinite(values)
        time = times[filled] if times.size == values.size else np.zeros(0)
        time = time[np.isfinite(time)]
        fits = name in (*ROLES, "time", "position", "setpoint")
        found.append(
            TopicContent(
                name,
                COLUMN,
                int(np.count_nonzero(filled)),
                rate(time),
                *limits(values[filled]),
                None,
                pauses(time - time[0]) if time.size else (),
                (COLUMN,),
                name if fits else None,
            )
        )
    return tuple(found)


def rate(time: Signal) -> float | None:
    """One over the median interval [1/s], where there is one."""
    interval = float(np.median(np.diff(time))) if time.size > 1 else 0.0
    return 1.0 / interval if interval > 0.0 else None


def limits(values: Signal) -> tuple[float | None, float | None]:
    """The least and the largest finite value."""
    finite = values[np.isfinite(values)]
    return (float(np.min(finite)), float(np.max(finite))) if finite.size else (None, None)


def clocks(found: Messages) -> tuple[str, ...]:
    """The clocks that the messages themselves carry."""
    has = {
        "stamp": found.type == cdr.JOINT_STATE and len(found) > 0 and bool(np.any(cdr.stamp(found))),
        "publish": bool(np.any(found.publish_time)),
        "log": bool(np.any(found.log_time)),
    }
    return tuple(name for name, is_there in has.items() if is_there)
