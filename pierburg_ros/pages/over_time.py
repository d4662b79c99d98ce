"""Plots over time: panels below each other that share their time, with windows shaded and gaps marked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from pierburg_ros.arrays import Signal

BUCKETS = 1500
"""Stretches of time of which a curve shows the lowest and the highest sample. Derived: as many as a wide screen has
pixels for the plot."""
COLOURS = {
    "measured": "#1f2933",
    "nominal": "#c2413b",
    "recalibrated": "#e08e2b",
    "final": "#2563a8",
    "simulated": "#d62728",
    "residual": "#1f77b4",
    "input": "#4b8b57",
}
"""What a curve is drawn in where no page says otherwise; a page has its own colours by these names, light and dark."""
OTHERS = 8
"""Colours that a page has for further curves, `other-0` and so on."""
WINDOW, MISSING = "#f5c542", "#8a94a0"
SHADE = {"type": "rect", "line": {"width": 0}, "layer": "below"}
"""A rectangle behind the curves."""


@dataclass(frozen=True)
class Curve:
    """`plus` less `minus` over time; the keys say where a page has both signals.

    `group` ties curves of one thing together, for a legend and for switches.
    """

    name: str
    group: str
    colour: str
    plus: tuple[str, Signal]
    minus: tuple[str, Signal] | None = None
    shown: bool = True
    steps: bool = False


@dataclass(frozen=True)
class Panel:
    """Curves with one axis; `band` is what noise fills to either side of zero."""

    title: str
    axis: str
    curves: Sequence[Curve]
    share: float = 1.0
    band: float | None = None


@dataclass(frozen=True)
class Span:
    """A stretch of time [s], with what to write into it."""

    start: float
    end: float
    text: str = ""
    missing: bool = False


def over_time(time: tuple[str, Signal], panels: Sequence[Panel], spans: Sequence[Span] = ()) -> go.Figure:
    """`panels` over `time` [s], with its key on a page."""
    heights = [panel.share for panel in panels]
    plot = make_subplots(
        rows=len(panels),
        cols=1,
        shared_xaxes=True,
        vertical_spacing=0.06,
        row_heights=heights,
        subplot_titles=[panel.title for panel in panels],
    )
    known: set[str] = set()
    for row, panel in enumerate(panels, start=1):
        for curve in panel.curves:
            plot.add_trace(_trace(time, curve, curve.group not in known), row, 1)
            known.add(curve.group)
        plot.update_yaxes(title_text=panel.axis, row=row, col=1)
    plot.update_xaxes(title_text="time [s]", row=len(panels), col=1)
    # all at once: Plotly checks every shape there is when one is added
    shades = [*_bands(panels), *(_shade(span, row) for span in spans for row in range(1, len(panels) + 1))]
    notes = [*plot.layout.annotations, *(_note(span) for span in spans if span.text)]
    plot.update_layout(hovermode="x", shapes=shades, annotations=notes)
    return finished(plot)


def _trace(time: tuple[str, Signal], curve: Curve, first: bool) -> go.Scatter:
    values = curve.plus[1] if curve.minus is None else curve.plus[1] - curve.minus[1]
    x, y = thinned(time[1], values)
    meta = {"time": time[0], "plus": curve.plus[0], "colour": curve.colour, "label": curve.name}
    if curve.minus is not None:
        meta["minus"] = curve.minus[0]
    return go.Scatter(
        x=np.round(x, 3).astype(np.float32),
        y=y.astype(np.float32),
        name=curve.name,
        line={"color": COLOURS.get(curve.colour, MISSING), "width": 1.3, "shape": "hv" if curve.steps else "linear"},
        legendgroup=curve.group,
        showlegend=first,
        visible=curve.shown,
        mode="lines",
        meta=meta,
    )


def _bands(panels: Sequence[Panel]) -> Iterator[dict[str, Any]]:
    """What noise fills in each panel, all along it."""
    for row, panel in enumerate(panels, start=1):
        if panel.band is not None:
            across = {"xref": f"{_axis('x', row)} domain", "x0": 0, "x1": 1}
            yield {**SHADE, **across, "yref": _axis("y", row), "y0": -panel.band, "y1": panel.band,
                   "fillcolor": MISSING, "opacity": 0.3}  # fmt: skip


def _shade(span: Span, row: int) -> dict[str, Any]:
    """A span in the panel of a row, over all its height."""
    colour, opacity = (MISSING, 0.45) if span.missing else (WINDOW, 0.28)
    along = {"xref": _axis("x", row), "x0": span.start, "x1": span.end}
    return {**SHADE, **along, "yref": f"{_axis('y', row)} domain", "y0": 0, "y1": 1,
            "fillcolor": colour, "opacity": opacity}  # fmt: skip


def _note(span: Span) -> dict[str, Any]:
    """What is written into a span, in the first panel."""
    where = {"x": (span.start + span.end) / 2, "xref": "x", "y": 1.0, "yref": "y domain", "yanchor": "top"}
    return {**where, "text": span.text, "showarrow": False}


def _axis(kind: str, row: int) -> str:
    """What Plotly calls the axis of a row."""
    return kind if row == 1 else f"{kind}{row}"


def thinned(time: Signal, values: Signal) -> tuple[Signal, Signal]:
    """Time and `values` with the lowest and the highest sample of each stretch kept, so that no peak is lost."""
    if time.size <= 2 * BUCKETS:
        return time, values
    kept = extremes(values, BUCKETS)
    return time[kept], values[kept]


def extremes(values: Signal, buckets: int) -> np.ndarray:
    """Indices of the first and last sample, and of the lowest and the highest one of each of `buckets` stretches."""
    first = np.linspace(0, values.size, buckets, endpoint=False).astype(int)
    parts = np.split(values, first[1:])
    lowest = first + [int(np.argmin(part)) for part in parts]
    highest = first + [int(np.argmax(part)) for part in parts]
    return np.unique(np.concatenate([[0], lowest, highest, [values.size - 1]]))


def finished(plot: go.Figure, height: int = 900) -> go.Figure:
    """`plot` as it looks outside a page."""
    plot.update_annotations(font_size=12)
    return plot.update_layout(
        height=height,
        template="plotly_white",
        legend={"orientation": "h", "y": 1.06, "yanchor": "bottom", "x": 0},
    )
