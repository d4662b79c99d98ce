"""Plots of a recording by itself: what was measured, and the input."""

from __future__ import annotations

import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from pierburg_ros.actuators.units import Motion
from pierburg_ros.actuators.wording import input_title, quantity_title
from pierburg_ros.comparison.plot import COLOURS, drawn_input
from pierburg_ros.recording import Recording


def figure(recording: Recording, unit: str, motion: Motion, title: str) -> go.Figure:
    """Measured quantity in its `unit` and input over time [s], as a Plotly figure."""
    plot = make_subplots(rows=2, shared_xaxes=True, row_heights=[0.7, 0.3], vertical_spacing=0.05)
    driving = drawn_input(recording)
    for row, name, values, shape in ((1, "measured", recording.measured, "linear"), (2, "input", driving, "hv")):
        line = {"color": COLOURS[name], "width": 1.5, "shape": shape}
        plot.add_trace(go.Scatter(x=recording.time, y=values, name=name, line=line), row=row, col=1)
    plot.update_yaxes(title_text=quantity_title(recording.quantity, unit), row=1)
    plot.update_yaxes(title_text=input_title(recording.input, motion), row=2)
    plot.update_xaxes(title_text="time [s]", row=2)
    return plot.update_layout(title=title, template="plotly_white", height=600, showlegend=False)


def picture(recording: Recording, unit: str, motion: Motion, title: str) -> Figure:
    """The same as a Matplotlib figure."""
    drawn = Figure(figsize=(10, 5), layout="constrained")
    FigureCanvasAgg(drawn)
    signal, driving = drawn.subplots(2, sharex=True, height_ratios=[7, 3])
    signal.set_title(title, fontsize=10)
    signal.plot(recording.time, recording.measured, color=COLOURS["measured"], linewidth=1.2)
    driving.step(recording.time, drawn_input(recording), where="post", color=COLOURS["input"], linewidth=0.8)
    signal.set_ylabel(quantity_title(recording.quantity, unit))
    driving.set_ylabel(input_title(recording.input, motion))
    driving.set_xlabel("time [s]")
    return drawn
