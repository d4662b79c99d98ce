"""Signals and remarks that lie over a recording in a viewer."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.file_times import FileTimes


@dataclass(frozen=True)
class Window:
    """A part of a recording to look at: `start` and `end` [s], its `share` of the mismatch, and what it is."""

    start: float
    end: float
    share: float
    text: str


@dataclass(frozen=True)
class Overlay:
    """What a `job` found in the recording called `title`.

    `signals` by name, each times [s] and values; `remarks` are times [s] and texts. Times are the recording's;
    `file_times` tells when its samples lie in its file.
    """

    job: str
    title: str
    signals: Mapping[str, tuple[Signal, Signal]]
    remarks: Sequence[tuple[float, str]]
    file_times: FileTimes


def window_share(time: Signal, windows: Iterable[Window]) -> Signal:
    """Share of the mismatch of the window in which each sample lies, 0 outside of all; shape (samples,)."""
    share = np.zeros(time.size)
    for window in windows:
        share[(time >= window.start) & (time <= window.end)] = window.share
    return share


def remarks_on(windows: Sequence[Window]) -> list[tuple[float, str]]:
    """A remark where each window begins."""
    count = len(windows)
    return [
        (each.start, f"window {number} of {count}, {each.start:.2f} to {each.end:.2f} s: {each.text}")
        for number, each in enumerate(windows, 1)
    ]
