"""Plots of a recording by itself: what was measured, and the duty."""

from __future__ import annotations

import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from pierburg_ros.comparison.plot import COLOURS
from pierburg_ros.pages.over_time import label
from pierburg_ros.recording import Recording


def figure(recording: Recording, title: str) -> go.Figure:
    """Measured quantity and duty [%] over time [s], as a Plotly figure."""
    plot = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.7, 0.3], vertical_spacing=0.05)
    duty = 100.0 * recording.command.at(recording.time, before=0.0)
    for row, name, values, shape in ((1, "measured", recording.measured, "linear"), (2, "duty", duty, "hv")):
        line = {"color": COLOURS[name], "width": 1.5, "shape": shape}
        plot.add_trace(go.Scatter(x=recording.time, y=values, name=name, line=line), row=row, col=1)
    plot.update_yaxes(title_text=label(recording.quantity, recording.unit), row=1)
    plot.update_yaxes(title_text="duty [%]", row=2)
    plot.update_xaxes(title_text="time [s]", row=2)
    return plot.update_layout(title=title, template="plotly_white", height=600, showlegend=False)


def picture(recording: Recording, title: str) -> Figure:
    """The same as a Matplotlib figure."""
    drawn = Figure(figsize=(10, 5), layout="constrained")
    FigureCanvasAgg(drawn)
    signal, duty = drawn.subplots(2, sharex=True, height_ratios=[7, 3])
    signal.set_title(title, fontsize=10)
    signal.plot(recording.time, recording.measured, color=COLOURS["measured"], linewidth=1.2)
    percent = 100.0 * recording.command.at(recording.time, before=0.0)
    duty.step(recording.time, percent, where="post", color=COLOURS["duty"], linewidth=0.8)
    signal.set_ylabel(label(recording.quantity, recording.unit))
    duty.set_ylabel("duty [%]")
    duty.set_xlabel("time [s]")
    return drawn
