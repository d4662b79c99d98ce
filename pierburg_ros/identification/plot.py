"""Plots of an identification: the settled angles with both branches, the fit over time, the correlations."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np
import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from pierburg_ros.actuators.wording import quantity_title
from pierburg_ros.comparison.plot import COLOURS
from pierburg_ros.identification.identify import Identification
from pierburg_ros.identification.paper.static_characteristic import StaticCharacteristic
from pierburg_ros.recording import Recording

BRANCHES = ((1, "opening", "#d62728"), (-1, "closing", "#1f77b4"))


def branch(static: StaticCharacteristic, direction: int, upper_stop: float) -> tuple[np.ndarray, np.ndarray]:
    """Duty [%] and settled angle [degrees] of one branch, flat on the stops."""
    offset = static.preload_duty.value + direction * static.coulomb_duty.value
    top = offset + upper_stop / static.gain.value
    duty = np.array([min(0.0, offset), offset, top, max(top, 0.3)])
    return 100.0 * duty, np.degrees(np.clip([static.angle(d, direction) for d in duty], 0.0, upper_stop))


def draw_static(figure: Figure, static: StaticCharacteristic, upper_stop: float, title: str) -> None:
    """Draw the settled angles and both branches into `figure`, like the paper's Fig. 3."""
    axes = figure.subplots()
    for direction, name, colour in BRANCHES:
        points = [point for point in static.points if point.direction == direction]
        axes.plot(*branch(static, direction, upper_stop), color=colour, label=f"{name}, fitted")
        axes.plot(
            [100.0 * point.duty for point in points],
            [np.degrees(point.angle) for point in points],
            "o",
            color=colour,
            markersize=4,
            label=f"{name}, settled angles",
        )
    axes.axvline(100.0 * static.preload_duty.value, color="grey", linestyle=":", linewidth=1)
    axes.annotate("$D_{pre}$", (100.0 * static.preload_duty.value, 92.0), ha="center", fontsize=9)
    axes.annotate(
        "",
        (100.0 * static.preload_duty.value, 4.0),
        (100.0 * (static.preload_duty.value + static.coulomb_duty.value), 4.0),
        arrowprops={"arrowstyle": "<->", "color": "grey"},
    )
    middle = 100.0 * (static.preload_duty.value + 0.5 * static.coulomb_duty.value)
    axes.annotate("$D_c$", (middle, 6.0), ha="center", fontsize=9)
    axes.set(xlabel="duty [%]", ylabel="settled angle [degrees]", xlim=(-2.0, 32.0), ylim=(-4.0, 98.0))
    axes.set_title(title, fontsize=10)
    axes.legend(fontsize=8, loc="upper left")


def static_picture(static: StaticCharacteristic, upper_stop: float) -> Figure:
    """The static characteristic as a Matplotlib figure."""
    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    FigureCanvasAgg(figure)
    title = (
        f"$D_c$ = {100 * static.coulomb_duty.value:.3f} %, $D_{{pre}}$ ="
        f" {100 * static.preload_duty.value:.3f} %, scatter {np.degrees(static.scatter):.2g} degrees"
    )
    draw_static(figure, static, upper_stop, title)
    return figure


def page(found: Identification, recordings: Sequence[Recording]) -> go.Figure:
    """Measured and simulated, residual, static characteristic and correlations, as a Plotly figure."""
    figure = make_subplots(
        rows=3,
        cols=2,
        specs=[[{"colspan": 2}, None], [{"colspan": 2}, None], [{}, {}]],
        row_heights=[0.4, 0.2, 0.4],
        subplot_titles=("measured and simulated", "residual", "settled angles", "correlation"),
        vertical_spacing=0.08,
    )
    start = 0.0
    for recording, residual in zip(recordings, found.fitted.residuals, strict=True):
        time = start + recording.time - recording.time[0]
        for name, values, row in (
            ("measured", recording.measured, 1),
            ("simulated", recording.measured - residual, 1),
            ("residual", residual, 2),
        ):
            line = {"color": COLOURS[name], "width": 1.2}
            trace = go.Scattergl(x=time, y=values, name=name, line=line, showlegend=start == 0.0)
            figure.add_trace(trace, row=row, col=1)
        start += recording.duration
    _add_static(figure, found)
    names = list(found.fitted.names)
    heat = go.Heatmap(z=found.fitted.correlation, x=names, y=names, zmin=-1, zmax=1, texttemplate="%{z:.2f}")
    heat.colorscale = "RdBu"
    figure.add_trace(heat, row=3, col=2)
    figure.update_yaxes(title_text=_title(found, recordings[0]), row=1)
    figure.update_xaxes(title_text="time [s], recordings one after another", row=2)
    title = f"Identification of {escape(found.model.actuator.name)}"
    return figure.update_layout(template="plotly_white", height=1000, title=title)


def _title(found: Identification, recording: Recording) -> str:
    return quantity_title(recording.quantity, found.model.actuator.shown(recording.unit))


def _add_static(figure: go.Figure, found: Identification) -> None:
    if found.static is None:
        return
    for direction, name, colour in BRANCHES:
        duty, angle = branch(found.static, direction, found.model.actuator.upper_stop)
        points = [point for point in found.static.points if point.direction == direction]
        figure.add_trace(go.Scatter(x=duty, y=angle, name=name, line={"color": colour}), row=3, col=1)
        marks = go.Scatter(
            x=[100.0 * point.duty for point in points],
            y=[np.degrees(point.angle) for point in points],
            name=f"{name}, settled",
            mode="markers",
            marker={"color": colour},
        )
        figure.add_trace(marks, row=3, col=1)
    figure.update_xaxes(title_text="duty [%]", row=3, col=1)
    figure.update_yaxes(title_text="angle [degrees]", row=3, col=1)
