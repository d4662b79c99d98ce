"""The report in one picture for print: signals, errors before and after, and input of the first recording."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import quantity_title
from pierburg_ros.diagnosis.report.figures import MEANINGS, driving_title
from pierburg_ros.diagnosis.report.page import headline
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.pages.over_time import COLOURS, WINDOW, thinned

DRAWN = ("measured", "nominal", "recalibrated", "final")


def picture(result: Result) -> Figure:
    """Signals, errors before and after, and input, as a Matplotlib figure."""
    diagnosis, signals = result.diagnosis, result.signals
    drawn = Figure(figsize=(10, 8), layout="constrained")
    FigureCanvasAgg(drawn)
    above, before, after, driving = drawn.subplots(4, sharex=True, height_ratios=[5, 3, 3, 2])
    for name in DRAWN:
        colour = COLOURS[name]
        _draw(above, signals, name, signals[name], colour)
        if name != "measured":
            _draw(after if name == "final" else before, signals, name, signals["measured"] - signals[name], colour)
    time, values = thinned(signals["time"], signals["command"])
    driving.step(time, values, where="post", color=COLOURS["input"], linewidth=0.8)
    if diagnosis.fit.noise_floor is not None:
        band = 1.96 * diagnosis.fit.noise_floor
        after.axhspan(-band, band, color="#9aa5b1", alpha=0.35, linewidth=0)
    for axes in (above, before, after, driving):
        axes.grid(alpha=0.25)
        for place in diagnosis.locations:
            axes.axvspan(place.start, place.end, color=WINDOW, alpha=0.3, linewidth=0)
    drawn.suptitle(headline(diagnosis), fontsize=11, parse_math=False)
    above.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, fontsize=8, frameon=False)
    above.set_ylabel(quantity_title(diagnosis.quantity, diagnosis.unit))
    before.set_ylabel(f"error before [{diagnosis.unit}]")
    after.set_ylabel(f"error after [{diagnosis.unit}]")
    driving.set_ylabel(driving_title(diagnosis))
    driving.set_xlabel("time [s]")
    return drawn


def _draw(axes: Axes, signals: dict[str, Any], name: str, values: Any, colour: str) -> None:
    axes.plot(*thinned(signals["time"], values), color=colour, linewidth=0.9, label=MEANINGS[name])
