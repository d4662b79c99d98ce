"""Plots of a comparison: measured and simulated, residual, input; to be zoomed and to be printed."""

from __future__ import annotations

from html import escape

import numpy as np
import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from pierburg_ros.actuators.wording import drawn_factor, input_title, quantity_title
from pierburg_ros.comparison.compare import Comparison
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


def page(comparison: Comparison) -> go.Figure:
    """Measured and simulated, residual, and input over time, as a Plotly figure."""
    recording = comparison.recording
    figure = make_subplots(rows=3, shared_xaxes=True, row_heights=[0.5, 0.3, 0.2], vertical_spacing=0.04)
    rows = (
        ("measured", recording.measured, 1),
        ("simulated", comparison.simulated, 1),
        ("residual", comparison.residual, 2),
        ("input", drawn_input(recording), 3),
    )
    for name, values, row in rows:
        line = {"color": COLOURS[name], "width": 1.5, "shape": "hv" if name == "input" else "linear"}
        figure.add_trace(go.Scattergl(x=recording.time, y=values, name=name, line=line), row=row, col=1)
    worst = comparison.worst
    figure.add_vrect(worst.start, worst.end, row=2, col=1, opacity=0.15, line_width=0, fillcolor="orange")
    figure.update_yaxes(title_text=quantity_title(recording.quantity, comparison.unit), row=1)
    figure.update_yaxes(title_text=f"residual [{comparison.unit}]", row=2)
    figure.update_yaxes(title_text=input_title(recording.input, comparison.model.actuator.motion), row=3)
    figure.update_xaxes(title_text="time [s]", row=3)
    return figure.update_layout(title=escape(title(comparison)), template="plotly_white", height=800)


def picture(comparison: Comparison) -> Figure:
    """The same three plots as a Matplotlib figure."""
    recording = comparison.recording
    figure = Figure(figsize=(10, 6.5), layout="constrained")
    FigureCanvasAgg(figure)
    signal, residual, driving = figure.subplots(3, sharex=True, height_ratios=[5, 3, 2])
    signal.set_title(title(comparison), fontsize=10, parse_math=False)
    for name, values, style in (
        ("measured", recording.measured, "-"),
        ("simulated", comparison.simulated, "--"),
    ):
        signal.plot(recording.time, values, style, color=COLOURS[name], linewidth=1.2, label=name)
    signal.legend(loc="upper right", fontsize=8)
    residual.plot(recording.time, comparison.residual, color=COLOURS["residual"], linewidth=0.8)
    worst = comparison.worst
    residual.axvspan(worst.start, worst.end, color="orange", alpha=0.2, label="worst stretch")
    residual.legend(loc="upper right", fontsize=8)
    driving.step(recording.time, drawn_input(recording), where="post", color=COLOURS["input"], linewidth=0.8)
    signal.set_ylabel(quantity_title(recording.quantity, comparison.unit))
    residual.set_ylabel(f"residual [{comparison.unit}]")
    driving.set_ylabel(input_title(recording.input, comparison.model.actuator.motion))
    driving.set_xlabel("time [s]")
    return figure
