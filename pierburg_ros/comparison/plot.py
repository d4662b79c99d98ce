"""Plots of a comparison: measured and simulated, residual, input; to be zoomed and to be printed."""

from __future__ import annotations

from html import escape

import numpy as np
import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import drawn_factor, input_title, quantity_title
from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.pages.over_time import Curve, Panel, Span, over_time, thinned
from pierburg_ros.recording import Recording

COLOURS = {"measured": "#7f7f7f", "simulated": "#d62728", "residual": "#1f77b4", "input": "#2ca02c"}


def title(comparison: Comparison) -> str:
    """One line that says what is compared and how far apart it is."""
    unit = comparison.unit
    return (
        f"{comparison.recording.name} and {comparison.model.actuator.name}:"
        f" RMSE {comparison.rmse:.4g} {unit}, measurement noise {comparison.noise:.2g} {unit}"
    )


def drawn_input(recording: Recording) -> np.ndarray:
    """The input in force at each sample, as it is drawn: a duty in per cent."""
    return drawn_factor(recording.input) * recording.command.at(recording.time, before=0.0)


def figure(comparison: Comparison) -> go.Figure:
    """Measured and simulated, residual, and input over time, as a Plotly figure; the worst stretch is shaded."""
    recording = comparison.recording
    measured, residual = ("0/measured", recording.measured), ("0/residual", comparison.residual)
    command = "0/command", drawn_input(recording)
    signals = [
        Curve("measured", "measured", "measured", measured),
        Curve("simulated", "simulated", "simulated", measured, residual),
    ]
    unit = comparison.unit
    panels = [
        Panel("measured and simulated", quantity_title(recording.quantity, unit), signals, 0.45),
        Panel(
            "residual; grey: noise",
            f"residual [{unit}]",
            [Curve("residual", "residual", "residual", residual)],
            0.33,
            1.96 * comparison.noise,
        ),
        Panel(
            "input",
            input_title(recording.input, comparison.model.actuator.motion),
            [Curve("input", "input", "input", command, steps=True)],
            0.22,
        ),
    ]
    spans = [Span(comparison.worst.start, comparison.worst.end)]
    spans += [Span(*span, missing=True) for span in recording.unknown_input]
    drawn = over_time(("0/time", recording.time), panels, spans)
    return drawn.update_layout(title=escape(title(comparison)), height=800)


def picture(comparison: Comparison) -> Figure:
    """The same three plots as a Matplotlib figure."""
    recording = comparison.recording
    drawn = Figure(figsize=(10, 6.5), layout="constrained")
    FigureCanvasAgg(drawn)
    signal, residual, driving = drawn.subplots(3, sharex=True, height_ratios=[5, 3, 2])
    signal.set_title(title(comparison), fontsize=10, parse_math=False)
    for name, values, style in (
        ("measured", recording.measured, "-"),
        ("simulated", comparison.simulated, "--"),
    ):
        signal.plot(*thinned(recording.time, values), style, color=COLOURS[name], linewidth=1.2, label=name)
    signal.legend(loc="upper right", fontsize=8)
    residual.plot(*thinned(recording.time, comparison.residual), color=COLOURS["residual"], linewidth=0.8)
    worst = comparison.worst
    residual.axvspan(worst.start, worst.end, color="orange", alpha=0.2, label="worst stretch")
    residual.legend(loc="upper right", fontsize=8)
    driving.step(*thinned(recording.time, drawn_input(recording)), where="post", color=COLOURS["input"], linewidth=0.8)
    signal.set_ylabel(quantity_title(recording.quantity, comparison.unit))
    residual.set_ylabel(f"residual [{comparison.unit}]")
    driving.set_ylabel(input_title(recording.input, comparison.model.actuator.motion))
    driving.set_xlabel("time [s]")
    return drawn
