"""An overlay as an MCAP file, to be opened beside the recording in Foxglove or PlotJuggler.

Every message has the log and publish time of the measured message it belongs to, so that both files line up whichever
of them a viewer takes. The topics are in a namespace of the job, so that none is called like one of the recording.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.mcap_writer import TYPES, McapWriter
from pierburg_ros.viewers.overlay import Overlay

LOG = "rcl_interfaces/msg/Log"
"""The type of /rosout, which log panels show."""
INFO = 20
"""Severity of a remark."""
REMARKS = "remarks"
"""Last name of the topic of the remarks."""

Message = tuple[str, bytes, int, int, int]
"""Topic, data, log time [ns], publish time [ns] and number among those of its topic."""


def write_mcap(path: Path, overlay: Overlay) -> None:
    """Write the file; each signal is a std_msgs/Float64 topic, the remarks are a topic of rcl_interfaces/Log."""
    messages = [*_signals(overlay), *_remarks(overlay)]
    with path.open("wb") as stream, McapWriter(stream) as writer:
        for name in overlay.signals:
            writer.declare(topic(overlay, name), cdr.FLOAT64)
        writer.declare(topic(overlay, REMARKS), LOG)
        for message in sorted(messages, key=lambda each: each[2]):
            writer.write(*message)


def topic(overlay: Overlay, name: str) -> str:
    """`/replay/residual`."""
    return f"/{overlay.job}/{name}"


def _signals(overlay: Overlay) -> list[Message]:
    """One message for each value of each signal."""
    messages: list[Message] = []
    for name, (time, values) in overlay.signals.items():
        log_times, publish_times = (times.tolist() for times in overlay.file_times.at(time))
        data = cdr.encode_float64(np.asarray(values, np.float64))
        numbers = range(len(data))
        messages += zip([topic(overlay, name)] * len(data), data, log_times, publish_times, numbers, strict=True)
    return messages


def _remarks(overlay: Overlay) -> list[Message]:
    """One message for each remark."""
    log_times, publish_times = overlay.file_times.at([time for time, _ in overlay.remarks])
    return [
        (topic(overlay, REMARKS), remark(text, log_time), log_time, publish_time, number)
        for number, ((_, text), log_time, publish_time) in enumerate(
            zip(overlay.remarks, log_times.tolist(), publish_times.tolist(), strict=True)
        )
    ]


def remark(text: str, stamp: int) -> bytes:
    """One rcl_interfaces/Log of the package with its `stamp` [ns]."""
    time = TYPES.types["builtin_interfaces/msg/Time"](stamp // 10**9, stamp % 10**9)
    return bytes(TYPES.serialize_cdr(TYPES.types[LOG](time, INFO, "pierburg_ros", text, "", "", 0), LOG))
