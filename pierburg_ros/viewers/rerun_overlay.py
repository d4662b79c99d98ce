"""Overlays as one file for the Rerun viewer; needs the extra `rerun`."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError
from pierburg_ros.viewers.overlay import Overlay

APPLICATION = "pierburg_ros"
SINCE, RECORDED = "since_first_sample", "recorded"
"""Time lines: seconds since the first sample, and the log time in the file of the recording."""


def check_rerun() -> None:
    """Refuse where the library that writes the file is not installed."""
    if find_spec("rerun") is None:
        raise InputError(
            "A file for the Rerun viewer needs rerun-sdk, which is not installed. Install it with"
            " pip install 'pierburg_ros[rerun]',"
            " or leave that file out."
        )


def write_rerun(path: Path, overlays: Sequence[Overlay]) -> None:
    """Write signals and remarks to the file `path`, each recording a branch of its own; whole, or not at all."""
    check_rerun()
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=f".{path.name}-", suffix=".rrd", dir=path.parent)
    os.close(handle)
    try:
        _write(temporary, overlays)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    finally:
        Path(temporary).unlink(missing_ok=True)


def _write(path: str, overlays: Sequence[Overlay]) -> None:
    """Write a file in place, with the views that it opens with."""
    import rerun as rr

    stream = rr.RecordingStream(APPLICATION)
    stream.save(path, default_blueprint=_views(rr, overlays))
    for number, overlay in enumerate(overlays):
        for name, (time, values) in overlay.signals.items():
            scalars = rr.Scalars.columns(scalars=np.asarray(values, np.float64))
            stream.send_columns(f"{branch(number)}/{name}", indexes=_times(rr, overlay, time), columns=scalars)
        moments, texts = np.array([time for time, _ in overlay.remarks]), [text for _, text in overlay.remarks]
        remarks = rr.TextLog.columns(text=texts)
        stream.send_columns(f"{branch(number)}/remarks", indexes=_times(rr, overlay, moments), columns=remarks)
    stream.flush()
    stream.disconnect()


def branch(number: int) -> str:
    """Where the signals of a recording stand: names of files may hold anything, a number is safe."""
    return f"recording_{number + 1}"


def _times(rr: Any, overlay: Overlay, time: np.ndarray) -> list[Any]:
    """The moments [s] on both time lines."""
    log_times, _ = overlay.file_times.at(time)
    return [
        rr.TimeColumn(SINCE, duration=np.asarray(time, np.float64)),
        rr.TimeColumn(RECORDED, timestamp=log_times.astype("datetime64[ns]")),
    ]


def _views(rr: Any, overlays: Sequence[Overlay]) -> Any:
    """A tab for each recording: what was measured and simulated, what is left, where it gathers, what drove it."""
    import rerun.blueprint as rrb

    def view(number: int, name: str, *signals: str) -> Any:
        held = [signal for signal in signals if signal in overlays[number].signals]
        return rrb.TimeSeriesView(name=name, origin=branch(number), contents=[f"$origin/{each}" for each in held])

    return rrb.Blueprint(
        rrb.Tabs(
            *(
                rrb.Vertical(
                    view(number, "measured and simulated", "measured", "nominal", "corrected", "simulated"),
                    view(number, "residual", "nominal_residual", "residual"),
                    view(number, "share of the mismatch", "window_share"),
                    view(number, "command", "command"),
                    rrb.TextLogView(name="remarks", origin=f"{branch(number)}/remarks"),
                    name=overlay.title,
                )
                for number, overlay in enumerate(overlays)
            )
        )
    )
