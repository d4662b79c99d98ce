"""What a result lays over its recordings in a viewer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pierburg_ros.comparison import compare as comparison
from pierburg_ros.recording import Recording
from pierburg_ros.recording.file_times import FileTimes, counted
from pierburg_ros.viewers.overlay import Overlay, Window, remarks_on, window_share

if TYPE_CHECKING:
    from pierburg_ros.diagnosis.result import Result, View
    from pierburg_ros.diagnosis.schema import Diagnosis

ACTED = ("supply_voltage", "temperature", "enabled", "setpoints")
"""Channels beside the command that a recording may hold."""
MODELS = (("nominal", "nominal", "nominal_residual"), ("final", "corrected", "residual"))
"""Models of a diagnosis, with the names of what they give and of what they leave."""


def of_comparison(found: comparison.Comparison) -> Overlay:
    """A recording, what a model makes of its inputs, the residual, and the worst stretch."""
    recording, worst = found.recording, found.worst
    time = recording.time
    said = f"RMSE {worst.rmse:.4g} {found.unit}, {100 * worst.share:.0f} % of the residual's energy"
    windows = [Window(worst.start, worst.end, worst.share, said)]
    channels = {name: each for name in ACTED if (each := getattr(recording, name)) is not None}
    signals = {
        "measured": (time, recording.measured),
        "simulated": (time, found.simulated),
        "residual": (time, found.residual),
        "window_share": (time, window_share(time, windows)),
        "command": (recording.command.time, recording.command.values),
        **{name: (channel.time, channel.values) for name, channel in channels.items()},
    }
    title = f"{recording.name} and {found.model.actuator.name}: RMSE {found.rmse:.4g} {found.unit}"
    remarks = [(float(time[0]), title), *remarks_on(windows)]
    return Overlay("replay", recording.name, signals, remarks, times_of(recording))


def of_diagnosis(result: Result, recordings: Sequence[Recording]) -> list[Overlay]:
    """One for each of the diagnosed recordings, which come first, in their order.

    They are without models where signals are at fault and nothing was concluded.
    """
    views = result.exhibits.views or [_unconcluded(each) for each in recordings[: len(result.diagnosis.recordings)]]
    return [
        _of_view(view, result.diagnosis, number, times_of(recording))
        for number, (view, recording) in enumerate(zip(views, recordings, strict=False))
    ]


def _unconcluded(recording: Recording) -> View:
    """A recording as it was read, with no model beside it."""
    from pierburg_ros.diagnosis.result import View

    command, nothing = recording.command.at(recording.time, before=0.0), recording.time[:0]
    return View(recording.name, recording.time, recording.measured, command, nothing, nothing, {})


def _of_view(view: View, document: Diagnosis, number: int, times: FileTimes) -> Overlay:
    """A recording, the nominal and the corrected model, what both leave; windows are those of the first recording."""
    windows = [
        Window(each.start, each.end, each.share, f"{100 * each.share:.0f} % of the mismatch, {each.regime}")
        for each in (document.locations if number == 0 else ())
    ]
    signals = {"measured": view.measured, "command": view.command, "window_share": window_share(view.time, windows)}
    for model, simulated, residual in MODELS:
        if model in view.errors:
            signals |= {simulated: view.measured - view.errors[model], residual: view.errors[model]}
    left_out = [(start, f"left out until {end:.2f} s: {why}") for start, end, why in view.left_out]
    remarks = [(float(view.time[0]), document.summary), *remarks_on(windows), *left_out]
    return Overlay("diagnosis", view.name, {name: (view.time, each) for name, each in signals.items()}, remarks, times)


def times_of(recording: Recording) -> FileTimes:
    """When its samples lie in its file; one that was made in memory counts from its first sample."""
    return recording.file_times or counted(recording.time)
