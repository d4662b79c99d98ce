"""Plots of an identification: the settled angles with both branches, the fit over time, the correlations."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np
import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import input_title, quantity_title
from pierburg_ros.comparison.plot import drawn_input
from pierburg_ros.identification.identify import Identification
from pierburg_ros.identification.paper.static_characteristic import StaticCharacteristic
from pierburg_ros.pages.over_time import Curve, Panel, finished, over_time
from pierburg_ros.recording import Recording

BRANCHES = ((1, "opening", "#d62728"), (-1, "closing", "#1f77b4"))


def branch(static: StaticCharacteristic, direction: int, upper_stop: float) -> tuple[np.ndarray, np.ndarray]:
    """Duty [%] and settled angle [degrees] of one branch, flat on the stops."""
    offset = static.preload_duty.value + direction * static.coulomb_duty.value
    top = offset + upper_stop / static.gain.value
    duty = np.array([min(0.0, offset), offset, top, max(top, 0.3)])
    return 100.0 * duty, np.degrees(np.clip([static.angle(d, direction) for d in duty], 0.0, upper_stop))


def draw_static(drawn: Figure, static: StaticCharacteristic, upper_stop: float, title: str) -> None:
    """Draw the settled angles and both branches into `drawn`, like the paper's Fig. 3."""
    axes = drawn.subplots()
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
    drawn = Figure(figsize=(7.0, 4.5), layout="constrained")
    FigureCanvasAgg(drawn)
    title = (
        f"$D_c$ = {100 * static.coulomb_duty.value:.3f} %, $D_{{pre}}$ ="
        f" {100 * static.preload_duty.value:.3f} %, scatter {np.degrees(static.scatter):.2g} degrees"
    )
    draw_static(drawn, static, upper_stop, title)
    return drawn


def offsets(recordings: Sequence[Recording]) -> list[float]:
    """Start of each recording in a plot that shows them one after another [s]."""
    ends = np.cumsum([recording.duration for recording in recordings])
    return [0.0, *(float(end) for end in ends[:-1])]


def signals_of(found: Identification, recordings: Sequence[Recording]) -> dict[str, np.ndarray]:
    """Time of all recordings one after another [s], measured and residual in the measured unit, and input."""
    starts = offsets(recordings)
    return {
        "time": np.concatenate([r.time - r.time[0] + start for r, start in zip(recordings, starts, strict=True)]),
        "measured": np.concatenate([recording.measured for recording in recordings]),
        "residual": np.concatenate(found.fitted.residuals),
        "command": np.concatenate([drawn_input(recording) for recording in recordings]),
    }


def figure(found: Identification, recordings: Sequence[Recording]) -> go.Figure:
    """Measured and simulated, residual, and input over the time of all recordings one after another."""
    signals, unit = signals_of(found, recordings), found.model.actuator.shown(recordings[0].unit)
    measured, residual, command = ((f"0/{name}", signals[name]) for name in ("measured", "residual", "command"))
    answers = [
        Curve("measured", "measured", "measured", measured),
        Curve("simulated", "simulated", "simulated", measured, residual),
    ]
    left = [Curve("residual", "residual", "residual", residual)]
    panels = [
        Panel("measured and simulated", quantity_title(recordings[0].quantity, unit), answers, 0.45),
        Panel("residual; grey: noise", f"residual [{unit}]", left, 0.33, 1.96 * found.noise),
        Panel(
            "input",
            input_title(recordings[0].input, found.model.actuator.motion),
            [Curve("input", "input", "input", command, steps=True)],
            0.22,
        ),
    ]
    drawn = over_time(("0/time", signals["time"]), panels)
    return drawn.update_layout(title=f"Identification of {escape(found.model.actuator.name)}", height=800)


def correlation_figure(found: Identification) -> go.Figure:
    """Correlations of the fitted parameters."""
    names = [name.replace("_", " ") for name in found.fitted.names]
    heat = go.Heatmap(z=found.fitted.correlation, x=names, y=names, zmin=-1, zmax=1, texttemplate="%{z:.2f}")
    heat.colorscale, heat.showscale = "RdBu", False
    drawn = go.Figure(heat)
    drawn.update_yaxes(autorange="reversed")
    return finished(drawn, 420)


def static_figure(static: StaticCharacteristic, upper_stop: float) -> go.Figure:
    """The settled angles and both branches, like the paper's Fig. 3."""
    drawn = go.Figure()
    for direction, name, colour in BRANCHES:
        duty, angle = branch(static, direction, upper_stop)
        points = [point for point in static.points if point.direction == direction]
        drawn.add_trace(go.Scatter(x=duty, y=angle, name=f"{name}, fitted", line={"color": colour}, mode="lines"))
        marks = go.Scatter(
            x=[100.0 * point.duty for point in points],
            y=[np.degrees(point.angle) for point in points],
            name=f"{name}, settled",
            mode="markers",
            marker={"color": colour},
        )
        drawn.add_trace(marks)
    drawn.update_xaxes(title_text="duty [%]").update_yaxes(title_text="settled angle [degrees]")
    return finished(drawn, 380)
