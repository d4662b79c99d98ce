"""The report in one picture for print: signals, errors before and after, and input of the first recording."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import quantity_title
from pierburg_ros.diagnosis.report.figures import MEANINGS, MODELS, driving_title
from pierburg_ros.diagnosis.report.page import headline
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.pages.over_time import COLOURS, WINDOW, thinned

ERRORS = {"error before": ("nominal", "recalibrated"), "error after": ("final",)}
"""Which models each panel of errors shows."""


def picture(result: Result) -> Figure:
    """Signals, errors before and after where models were simulated, and input, as a Matplotlib figure."""
    diagnosis, signals = result.diagnosis, result.signals
    known = [name for name in MODELS if np.isfinite(signals[name]).all()]
    errors = {title: names for title, names in ERRORS.items() if set(names) <= {*known}}
    drawn = Figure(figsize=(10, 8), layout="constrained")
    FigureCanvasAgg(drawn)
    above, *middle, driving = drawn.subplots(2 + len(errors), sharex=True, height_ratios=[5, *(3 for _ in errors), 2])
    for name in ("measured", *known):
        _draw(above, signals, name, signals[name])
    for axes, (title, names) in zip(middle, errors.items(), strict=True):
        for name in names:
            _draw(axes, signals, name, signals["measured"] - signals[name])
        axes.set_ylabel(f"{title} [{diagnosis.unit}]")
    time, values = thinned(signals["time"], signals["command"])
    driving.step(time, values, where="post", color=COLOURS["input"], linewidth=0.8)
    if errors and diagnosis.fit.noise_floor is not None:
        band = 1.96 * diagnosis.fit.noise_floor
        middle[-1].axhspan(-band, band, color="#9aa5b1", alpha=0.35, linewidth=0)
    for axes in (above, *middle, driving):
        axes.grid(alpha=0.25)
        for place in diagnosis.locations:
            axes.axvspan(place.start, place.end, color=WINDOW, alpha=0.3, linewidth=0)
    drawn.suptitle(headline(diagnosis), fontsize=11, parse_math=False)
    above.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, fontsize=8, frameon=False)
    above.set_ylabel(quantity_title(diagnosis.quantity, diagnosis.unit))
    driving.set_ylabel(driving_title(diagnosis))
    driving.set_xlabel("time [s]")
    return drawn


def _draw(axes: Axes, signals: dict[str, Any], name: str, values: Any) -> None:
    axes.plot(*thinned(signals["time"], values), color=COLOURS[name], linewidth=0.9, label=MEANINGS[name])
