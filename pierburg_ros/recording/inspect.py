"""What is in a recording: every topic with its numbers, and the recording as the other commands read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.csv_table import read_table
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.formats.rosbag2 import read_bag
from pierburg_ros.recording.loss import Signal, Span, are_numbered, numbered_loss, pauses
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
    contents = columns(path) if path.suffix.lower() == ".csv" else messages(path, named)
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


def messages(path: Path, named: Mapping[str, str]) -> tuple[TopicContent, ...]:
    """The topics of an MCAP file, a sqlite3 file or a rosbag2 directory; `named` has the signal of some topics."""
    bag = read_bag(path, lambda _: True)
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


def columns(path: Path) -> tuple[TopicContent, ...]:
    """The columns of a CSV table."""
    table = read_table(path)
    times = numbers(table.get("time", []))
    found = []
    for name, cells in table.items():
        values = numbers(cells)
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


def numbers(cells: list[str]) -> Signal:
    """The cells as numbers, NaN where they are none."""
    found = np.full(len(cells), np.nan)
    for place, cell in enumerate(cells):
        try:
            found[place] = float(cell)
        except ValueError:
            continue
    return found


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
