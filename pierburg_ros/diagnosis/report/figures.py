"""The plots of the report: signals and errors over time and over the state, laws, residual torque."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import plotly.graph_objects as go

from pierburg_ros.actuators.units import Motion, unit_of
from pierburg_ros.actuators.wording import input_title, quantity_title, travel_factor, travel_title
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.report.allowed import Bar
from pierburg_ros.diagnosis.report.places import Place
from pierburg_ros.diagnosis.report.tried import title
from pierburg_ros.diagnosis.result import Characteristic, Tried, View
from pierburg_ros.diagnosis.schema import Diagnosis, ResidualTorque
from pierburg_ros.pages.over_time import COLOURS, OTHERS, Curve, Panel, Span, finished, over_time

MEANINGS = {
    "measured": "measured",
    "nominal": "model as described",
    "recalibrated": "parameters re-estimated",
    "final": "diagnosed model",
}
MODELS = ("nominal", "recalibrated", "final")
LAGS = 0.02
"""Longest lag of an autocorrelation, as a share of the first recording. Chosen: a second of a minute."""
SCATTERED = 1500
"""Number of points of an error over angle or velocity, roughly. Work: more lie on top of each other."""
NUMBERED = 6
"""Number of windows that are numbered in a plot. Chosen: more would overlap."""
ONE_NUMBER = 0.05
"""Windows closer than this share of the recording get one number between them. Derived: the width of two digits on a
phone."""


def time_figure(
    diagnosis: Diagnosis, view: View, tried: Sequence[Tried], places: Sequence[Place], prefix: str
) -> go.Figure:
    """A recording over time: signals, error re-estimated, error of the diagnosed model, input.

    The names of the `tried` switch them on and off; the keys of the signals begin with `prefix`.
    """
    measured = f"{prefix}/measured", view.measured

    def error(key: str) -> tuple[str, Signal]:
        return f"{prefix}/{key}", view.errors[key]

    def curves(key: str, name: str, colour: str, shown: bool) -> tuple[Curve, Curve]:
        return (
            Curve(name, key, colour, measured, error(key), shown),
            Curve(name, key, colour, error(key), shown=shown),
        )

    own = {key: curves(key, MEANINGS[key], key, key != "nominal") for key in MODELS if key in view.errors}
    rivals = [row for row in tried if row.key in view.errors and row.key != "final"]
    others = [curves(row.key, title(row), f"other-{place % OTHERS}", False) for place, row in enumerate(rivals)]
    unit, noise = diagnosis.unit, diagnosis.fit.noise_floor
    signals = [Curve("measured", "measured", "measured", measured), *(pair[0] for pair in (*own.values(), *others))]
    before = [*(own[key][1] for key in MODELS[:2] if key in own), *(pair[1] for pair in others)]
    band = None if noise is None else 1.96 * noise
    panels = [
        Panel("measured and simulated", quantity_title(diagnosis.quantity, unit), signals, 0.34),
        Panel("error of what is switched on", f"error [{unit}]", before, 0.24, band),
        Panel(
            "error of the diagnosed model; grey: noise",
            f"error [{unit}]",
            [own[key][1] for key in MODELS[2:] if key in own],
            0.24,
            band,
        ),
        Panel(
            "input",
            driving_title(diagnosis),
            [Curve("input", "input", "input", (f"{prefix}/command", view.command), steps=True)],
            0.18,
        ),
    ]
    spans = [
        Span(place.start, place.end, str(rank) if rank <= NUMBERED and apart(places[:rank], view.time) else "")
        for rank, place in enumerate(places, start=1)
    ]
    spans += [Span(start, end, missing=True) for start, end, _ in view.left_out]
    return over_time((f"{prefix}/time", view.time), [panel for panel in panels if panel.curves], spans)


def apart(places: Sequence[Place], time: Signal) -> bool:
    """Whether the last of some windows is far enough from all others for a number of its own."""
    *others, last = (0.5 * (place.start + place.end) for place in places)
    return all(abs(last - other) > ONE_NUMBER * np.ptp(time) for other in others)


def signal_figure(diagnosis: Diagnosis, signals: Mapping[str, Signal]) -> go.Figure:
    """Signals, errors and input of the first recording over time, the located windows shaded and numbered."""
    errors = {key: signals["measured"] - signals[key] for key in ("nominal", "recalibrated", "final")}
    nothing = np.zeros(0)
    view = View("", signals["time"], signals["measured"], signals["command"], nothing, nothing, errors)
    places = [Place(each.start, each.end, each.share, each.regime) for each in diagnosis.locations]
    return time_figure(diagnosis, view, (), places, "0")


def driving_title(diagnosis: Diagnosis) -> str:
    """Title of the axis of the input: a duty is a share, and has no unit."""
    return "duty" if diagnosis.input == "duty" else input_title(diagnosis.input, diagnosis.motion)


def autocorrelation_figure(views: Sequence[View]) -> go.Figure:
    """Autocorrelation of both errors over the lag, over all recordings, with the band of white noise."""
    plot = go.Figure()
    for key in ("recalibrated", "final"):
        lag, correlation, samples = autocorrelation(views, key)
        plot.add_trace(_line(lag, correlation, MEANINGS[key], key))
    bound = 1.96 / math.sqrt(max(samples, 1))
    plot.add_hrect(y0=-bound, y1=bound, fillcolor=COLOURS["measured"], opacity=0.2, line_width=0)
    plot.update_xaxes(title_text="lag [s]").update_yaxes(title_text="autocorrelation", range=[-1.05, 1.05])
    return finished(plot, 320)


def autocorrelation(views: Sequence[View], key: str) -> tuple[Signal, Signal, int]:
    """Lag [s], autocorrelation of an error by name, and the number of samples for it."""
    interval = float(np.median(np.diff(views[0].time)))
    count = min(max(int(LAGS * views[0].time.size), 2), *(view.time.size // 2 for view in views))
    total = np.zeros(count)
    for view in views:
        error = view.errors[key] - np.mean(view.errors[key])
        spectrum = np.abs(np.fft.rfft(error, 2 * error.size)) ** 2
        total += np.fft.irfft(spectrum)[:count]
    shown = np.unique(np.round(np.linspace(0, count - 1, 200)).astype(int))
    correlation = total / total[0] if total[0] > 0.0 else total
    return interval * shown, correlation[shown], sum(view.time.size for view in views)


def state_figure(views: Sequence[View], over: str, unit: str, motion: Motion) -> go.Figure:
    """Both errors over the `angle` or the `velocity` of all recordings."""
    plot = go.Figure()
    factor = travel_factor(motion) if over == "angle" else 1.0
    title = travel_title(motion) if over == "angle" else f"velocity [{unit_of('rad/s', motion)}]"
    state = np.concatenate([getattr(view, over) for view in views])
    for key in ("recalibrated", "final"):
        error = np.concatenate([view.errors[key] for view in views])
        kept = slice(None, None, max(1, state.size // SCATTERED))
        plot.add_trace(_points(factor * state[kept], error[kept], MEANINGS[key], key))
    plot.update_xaxes(title_text=title).update_yaxes(title_text=f"error [{unit}]")
    return finished(plot, 320)


def law_figure(law: Characteristic) -> go.Figure:
    """A law of each model, with points from the recordings around the final one."""
    plot = go.Figure()
    if law.points is not None:
        bars = {"type": "data", "array": law.points.error, "thickness": 1, "width": 0}
        shown = _points(law.points.x, law.points.y, "what the recordings say, 95 %", "measured", 0.9)
        plot.add_trace(shown.update(error_y=bars, marker={"size": 5}))
    for key, (x, y) in law.curves.items():
        plot.add_trace(_line(x, y, MEANINGS[key], key, {"nominal": "dot", "recalibrated": "dash"}.get(key, "solid")))
    plot.update_xaxes(title_text=law.x).update_yaxes(title_text=law.y)
    return finished(plot, 340)


def bars_figure(bars: Sequence[Bar]) -> go.Figure:
    """The largest size of each effect that the recordings allow, beside its typical size."""
    drawn = go.Bar(
        x=[bar.share for bar in bars],
        y=[bar.name for bar in bars],
        text=[bar.text for bar in bars],
        orientation="h",
        marker={"color": COLOURS["final"]},
        meta={"colour": "final"},
    )
    plot = go.Figure(drawn)
    plot.update_xaxes(title_text="largest size still allowed (95 %), as a share of a typical one", type="log")
    plot.add_vline(x=1.0, line_dash="dot", line_color=COLOURS["nominal"], layer="below")
    plot.update_yaxes(autorange="reversed")
    return finished(plot, bars_height(bars))


def bars_height(bars: Sequence[Bar]) -> int:
    """Height of the plot of the bars [px]."""
    return 90 + 26 * len(bars)


def horizons_figure(horizons: Mapping[str, Sequence[float | None]], names: Sequence[str], unit: str) -> go.Figure:
    """Error after each time of prediction from the measured state, for the three models."""
    plot = go.Figure()
    for key, errors in horizons.items():
        plot.add_trace(_line(list(names), list(errors), MEANINGS[key], key).update(mode="lines+markers"))
    plot.update_xaxes(title_text="predicted from the measured state for", type="category")
    plot.update_yaxes(title_text=f"error (RMSE) [{unit}]", type="log")
    return finished(plot, 320)


def torque_figure(residual: ResidualTorque, motion: Motion = "rotary") -> go.Figure:
    """The residual torque over angle and velocity."""
    largest = float(np.max(np.abs(residual.torque)))
    surface = go.Contour(
        x=[travel_factor(motion) * angle for angle in residual.angle],
        y=residual.velocity,
        z=np.transpose(residual.torque),
        colorscale="RdBu_r",
        zmin=-largest,
        zmax=largest,
        contours_coloring="heatmap",
        line_width=0.5,
        colorbar={"title": {"text": unit_of("N.m", motion)}, "thickness": 12},
    )
    plot = go.Figure(surface)
    plot.update_xaxes(title_text=travel_title(motion))
    plot.update_yaxes(title_text=f"velocity [{unit_of('rad/s', motion)}]")
    return finished(plot, 360)


def trend_figure(residual: ResidualTorque, motion: Motion = "rotary") -> go.Figure:
    """The missing torque over time."""
    over = residual.over_time
    assert over is not None
    plot = go.Figure(_line(over.time, over.torque, "missing torque", "final").update(mode="lines+markers"))
    plot.update_xaxes(title_text="time [s]").update_yaxes(title_text=f"mean missing load [{unit_of('N.m', motion)}]")
    return finished(plot, 360)


def _line(x: object, y: object, name: str, key: str, dash: str = "solid") -> go.Scatter:
    line = {"color": COLOURS[key], "width": 2, "dash": dash}
    return go.Scatter(x=x, y=y, name=name, mode="lines", line=line, meta={"colour": key})


def _points(x: Signal, y: Signal, name: str, key: str, opacity: float = 0.5) -> go.Scatter:
    marker = {"color": COLOURS[key], "size": 3, "opacity": opacity}
    few = x.astype(np.float32), y.astype(np.float32)
    return go.Scatter(x=few[0], y=few[1], name=name, mode="markers", marker=marker, meta={"colour": key})
