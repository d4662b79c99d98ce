"""The page of an identification: every parameter with its interval, the fit over time, the static characteristic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pierburg_ros.identification.identify import Identification
from pierburg_ros.identification.plot import correlation_figure, figure, offsets, signals_of, static_figure
from pierburg_ros.pages.page import NOT_FILES, Plot, Sources, written
from pierburg_ros.pages.room import page_signals
from pierburg_ros.recording import Recording


def identification_page(
    found: Identification,
    recordings: Sequence[Recording],
    provenance: Sequence[tuple[str, str]] = (),
    sources: Sources = NOT_FILES,
) -> str:
    """The page as HTML; `sources` for commands to copy."""
    content = found.as_mapping()
    starts = offsets(recordings)
    context = {
        "title": f"{found.model.actuator.name}, identified from {', '.join(each.name for each in recordings)}",
        "unit": found.model.actuator.shown(recordings[0].unit),
        "found": found,
        "parameters": parameter_rows(found, content),
        "lumps": content["lumps"] or {},
        "static": content["static_characteristic"] or {},
        "plot_over_time": Plot("time-0", figure(found, recordings), "The fit over the time of all recordings", 760),
        "stretches": [
            (recording.name, start, start + recording.duration)
            for recording, start in zip(recordings, starts, strict=True)
        ],
        "plots": state_plots(found),
    }
    return written(
        "pierburg_ros.identification",
        "identification.html",
        page_signals([signals_of(found, recordings)], ("measured", "residual")),
        context,
        model_file=found.fitted.model.text(),
        commands=sources.commands(
            ("See the identified model beside a recording", "replay", "replayed"),
            ("Ask what the identified model lacks", "diagnose", "diagnosis"),
        ),
        provenance=provenance,
    )


def parameter_rows(found: Identification, content: dict[str, Any]) -> list[dict[str, Any]]:
    """Every parameter for people: fitted, held, or not identifiable and why."""
    rows = []
    for name, entry in content["parameters"].items():
        reason = "" if entry["identifiable"] else found.findings[name].reason
        rows.append({"name": name, **entry, "nominal": found.model.values[name], "reason": reason})
    return rows


def state_plots(found: Identification) -> list[Plot]:
    """The static characteristic, where the recordings hold settled angles, and the correlations of several values."""
    plots = []
    if found.static is not None:
        drawn = static_figure(found.static, found.model.actuator.upper_stop)
        plots.append(Plot("static", drawn, "Settled angles and what was fitted to them", 380))
    if len(found.fitted.names) > 1:
        caption = "Correlation of the fitted values: 1 or -1 where only a combination of two is known"
        plots.append(Plot("correlation", correlation_figure(found), caption, 420))
    return plots
