"""What is in a recording, the recording as the other commands read it, and a signal map to edit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError
from pierburg_ros.intake import reading
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.formats import format_of
from pierburg_ros.recording.inspection.bag import topics as topics_of
from pierburg_ros.recording.inspection.content import TopicContent
from pierburg_ros.recording.inspection.draft import draft
from pierburg_ros.recording.inspection.table import columns, tables_in
from pierburg_ros.recording.read import read_recording
from pierburg_ros.recording.recording import Recording
from pierburg_ros.recording.signal_map import Given, SignalMap, signal_map


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
    signals: Given = None,
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
        contents, text = looked_into(path, chosen)
    return Inspection(path.name, contents, recording, problem, text)


def looked_into(path: Path, chosen: SignalMap) -> tuple[tuple[TopicContent, ...], str]:
    """Every topic or column at `path`, and the text of a signal map."""
    tables = tables_in(path) if path.is_dir() and not (path / "metadata.yaml").exists() else {}
    found = None if tables else format_of(path).read(path, lambda _: True)
    if found is not None and not isinstance(found, Columns):
        contents, guessed = topics_of(found, chosen)
        return contents, draft(path.name, filter(None, guessed.values()), None, False)
    contents, guessed, clock = columns(tables if found is None else {"": found}, chosen)
    return contents, draft(path.name, filter(None, guessed.values()), clock, True)


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
