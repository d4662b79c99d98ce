"""The page of a comparison: plots to be zoomed, the main numbers, every parameter of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.comparison.plot import drawn_input, figure
from pierburg_ros.effects import EFFECT
from pierburg_ros.pages.page import NOT_FILES, Plot, Sources, written
from pierburg_ros.pages.room import page_signals
from pierburg_ros.plant import Model


def replay_page(
    comparison: Comparison,
    rows: Mapping[str, str],
    provenance: Sequence[tuple[str, str]] = (),
    sources: Sources = NOT_FILES,
) -> str:
    """The page as HTML; `rows` are the main numbers in words; `sources` for commands to copy."""
    recording = comparison.recording
    signals = {
        "time": recording.time,
        "measured": recording.measured,
        "residual": comparison.residual,
        "command": drawn_input(recording),
    }
    caption = f"{recording.name}: measured and simulated, residual and input over time"
    context = {
        "title": f"{recording.name} and {comparison.model.actuator.name}",
        "rows": rows,
        "plot_over_time": Plot("time-0", figure(comparison), caption, 760),
        "worst": comparison.worst,
        "parameters": parameter_rows(comparison.model),
    }
    return written(
        "pierburg_ros.comparison",
        "replay.html",
        page_signals([signals], ("measured", "residual")),
        context,
        model_file=comparison.model.text(),
        model_said="The model that was simulated.",
        commands=sources.commands(("Ask what the model lacks", "diagnose", "diagnosis")),
        provenance=provenance,
    )


def parameter_rows(model: Model) -> list[tuple[str, float, float, str]]:
    """Name, value, nominal value and unit of every parameter that acts in a model."""
    actuator, nominal = model.actuator, Model.nominal(model.actuator)
    rows = [(name, model.values[name], nominal.values[name], actuator.unit_of(name)) for name in actuator.parameters]
    for effect in model.active_effects:
        for parameter in EFFECT[effect].parameters:
            name = f"{effect}.{parameter.name}"
            rows.append((name, model.values[name], nominal.values[name], actuator.unit_of(name)))
    return rows
