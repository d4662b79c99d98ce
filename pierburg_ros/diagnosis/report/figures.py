"""The plots of the report, to be zoomed: signals and errors over time, and what is left as torque."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from pierburg_ros.actuators.units import Motion, unit_of
from pierburg_ros.actuators.wording import input_title, quantity_title
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Diagnosis, ResidualTorque

BUCKETS = 1500
"""Stretches of time of which a curve shows the lowest and the highest sample. Derived: as many as a wide screen has
pixels for the plot."""
COLOURS = {"measured": "#1f2933", "nominal": "#c2413b", "recalibrated": "#e08e2b", "final": "#2563a8"}
INPUT = "#4b8b57"
WINDOW = "#f5c542"
MEANINGS = {
    "measured": "measured",
    "nominal": "model as described",
    "recalibrated": "parameters re-estimated",
    "final": "diagnosed model",
}


def thinned(time: Signal, values: Signal) -> tuple[Signal, Signal]:
    """Time and `values` with the lowest and the highest sample of each stretch kept, so that no peak is lost."""
    if time.size <= 2 * BUCKETS:
        return time, values
    first = np.linspace(0, time.size, BUCKETS, endpoint=False).astype(int)
    parts = np.split(values, first[1:])
    lowest = first + [int(np.argmin(part)) for part in parts]
    highest = first + [int(np.argmax(part)) for part in parts]
    kept = np.unique(np.concatenate([[0], lowest, highest, [time.size - 1]]))
    return time[kept], values[kept]


def signal_figure(diagnosis: Diagnosis, signals: Mapping[str, Signal]) -> go.Figure:
    """Signals, errors and input of the first recording over time, the located windows shaded and numbered."""
    titles = (
        "measured and simulated",
        "error before: measured less simulated",
        "error after, with the band that noise fills 95 % of the time",
        diagnosis.input,
    )
    heights = [0.34, 0.24, 0.24, 0.18]
    plot = make_subplots(
        rows=4, cols=1, shared_xaxes=True, vertical_spacing=0.055, row_heights=heights, subplot_titles=titles
    )
    for name in COLOURS:
        _curve(plot, 1, MEANINGS[name], signals["time"], signals[name], COLOURS[name], name)
        if name != "measured":
            error = signals["measured"] - signals[name]
            row = 3 if name == "final" else 2
            _curve(plot, row, MEANINGS[name], signals["time"], error, COLOURS[name], name, legend=False)
    _curve(plot, 4, diagnosis.input, signals["time"], signals["command"], INPUT, "input", legend=False)
    _shade(plot, diagnosis)
    errors = [f"error [{diagnosis.unit}]"] * 2
    axes = (quantity_title(diagnosis.quantity, diagnosis.unit), *errors, driving_title(diagnosis))
    for row, title in enumerate(axes, start=1):
        plot.update_yaxes(title_text=title, row=row, col=1)
    plot.update_xaxes(title_text="time [s]", row=4, col=1)
    return _styled(plot, 900).update_layout(hovermode="x")


def driving_title(diagnosis: Diagnosis) -> str:
    """Title of the axis of the input: a duty is a share, and has no unit."""
    return "duty" if diagnosis.input == "duty" else input_title(diagnosis.input, diagnosis.motion)


def _curve(
    plot: go.Figure, row: int, name: str, time: Signal, values: Signal, colour: str, group: str, legend: bool = True
) -> None:
    x, y = thinned(time, values)
    line = {"color": colour, "width": 1.3, "shape": "hv" if group == "input" else "linear"}
    few = np.round(x, 3).astype(np.float32), y.astype(np.float32)
    trace = go.Scatter(x=few[0], y=few[1], name=name, line=line, legendgroup=group, showlegend=legend)
    plot.add_trace(trace, row, 1)


def _shade(plot: go.Figure, diagnosis: Diagnosis) -> None:
    """Located windows in every row, the first ranks on top, and the noise in the row of the final error."""
    for rank, place in enumerate(diagnosis.locations, start=1):
        plot.add_vrect(
            x0=place.start, x1=place.end, row="all", col=1, fillcolor=WINDOW, opacity=0.28, line_width=0, layer="below"
        )
        if rank <= 6:  # more would overlap
            where = {"x": (place.start + place.end) / 2, "y": 1.0, "yref": "y domain", "yanchor": "top"}
            plot.add_annotation(**where, text=str(rank), showarrow=False, row=1, col=1)
    if diagnosis.fit.noise_floor is not None:
        band = 1.96 * diagnosis.fit.noise_floor
        plot.add_hrect(y0=-band, y1=band, row=3, col=1, fillcolor="#9aa5b1", opacity=0.35, line_width=0, layer="below")


def torque_figure(residual: ResidualTorque, motion: Motion = "rotary") -> go.Figure:
    """The residual torque over angle and velocity, and the missing torque over time beside it."""
    torque, velocity = unit_of("N.m", motion), unit_of("rad/s", motion)
    plot = make_subplots(rows=1, cols=2, column_widths=[0.58, 0.42], horizontal_spacing=0.16)
    largest = float(np.max(np.abs(residual.torque)))
    angles = [math.degrees(angle) if motion == "rotary" else angle for angle in residual.angle]
    surface = go.Contour(
        x=angles,
        y=residual.velocity,
        z=np.transpose(residual.torque),
        colorscale="RdBu_r",
        zmin=-largest,
        zmax=largest,
        contours_coloring="heatmap",
        line_width=0.5,
        colorbar={"title": torque, "x": 0.5, "thickness": 12},
    )
    plot.add_trace(surface, 1, 1)
    plot.update_xaxes(title_text="angle [degrees]" if motion == "rotary" else "position [m]", row=1, col=1)
    plot.update_yaxes(title_text=f"velocity [{velocity}]", row=1, col=1)
    if residual.over_time is not None:
        line = {"color": COLOURS["final"], "width": 1.5}
        trend = go.Scatter(
            x=residual.over_time.time, y=residual.over_time.torque, mode="lines+markers", line=line, showlegend=False
        )
        plot.add_trace(trend, 1, 2)
        plot.update_xaxes(title_text="time [s]", row=1, col=2)
        plot.update_yaxes(
            title_text=f"mean missing torque [{torque}]" if motion == "rotary" else f"mean missing force [{torque}]",
            row=1,
            col=2,
        )
    return _styled(plot, 400)


def _styled(plot: go.Figure, height: int) -> go.Figure:
    plot.update_annotations(font_size=12)
    plot.update_layout(
        height=height,
        template="plotly_white",
        margin={"t": 60, "l": 70, "r": 20, "b": 50},
        font={"family": "system-ui, sans-serif", "size": 12},
        legend={"orientation": "h", "y": 1.06, "yanchor": "bottom", "x": 0},
    )
    return plot
