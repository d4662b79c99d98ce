"""The report: one self-contained page with plots that can be zoomed, and one picture."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import quantity_title
from pierburg_ros.diagnosis.report.figures import (
    COLOURS,
    INPUT,
    MEANINGS,
    WINDOW,
    driving_title,
    signal_figure,
    thinned,
    torque_figure,
)
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.schema import Diagnosis

VERDICTS = {
    "consistent": "the model as described explains the recordings down to their noise",
    "parameter_drift": "the model's structure is right, its parameters have changed",
    "missing_physics": "the model lacks the effects named here, and with them it is right",
    "unexplained": "something is left that no effect of the catalogue removes",
}
"""What each verdict means."""
NOTHING = "nothing is concluded: the signals are not what they are read as"
"""What a verdict means where the input is at fault."""
ANGULAR = {"rad": "degrees", "rad/s": "degrees/s"}
"""Units in which people read an angle."""


def write_page(path: Path, result: Result) -> None:
    """Write the report as one page that needs no network."""
    diagnosis = result.diagnosis
    plot = _embedded(signal_figure(diagnosis, result.signals), True)
    torque = (
        _embedded(torque_figure(diagnosis.residual_torque, diagnosis.motion), False)
        if diagnosis.residual_torque
        else ""
    )
    path.write_text(page(diagnosis, plot, torque), encoding="utf-8")


def page(diagnosis: Diagnosis, plot: str, torque: str) -> str:
    """The page around the plots, which are HTML."""
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(number=number, interval=interval, words=words, percent=percent, ties=ties)
    source = resources.files("pierburg_ros.diagnosis.report") / "report.html"
    template = environment.from_string(source.read_text(encoding="utf-8"))
    return template.render(
        d=diagnosis,
        meaning=NOTHING if diagnosis.input_faults else VERDICTS[diagnosis.verdict],
        regimes=[regime_row(diagnosis, index) for index in range(len(diagnosis.regimes))],
        shown=12,  # candidates; the others are folded away
        plot=plot,
        torque=torque,
    )


def regime_row(diagnosis: Diagnosis, index: int) -> dict[str, Any]:
    """A regime for people: angles in degrees, shares as they stand."""
    regime = diagnosis.regimes[index]
    factor = math.degrees(1.0) if regime.unit in ANGULAR else 1.0
    unit = ANGULAR.get(regime.unit, "" if regime.unit == "1" else regime.unit)
    low, high = (factor * end for end in regime.range)
    return {
        "variable": words(regime.variable),
        "range": f"{low:.3g} to {high:.3g} {unit}",
        "residual": regime.share_of_residual,
        "time": regime.share_of_time,
        "chance": regime.chance,
    }


def _embedded(figure: Any, with_library: bool) -> str:
    """A plot as HTML, plotly.js within the first one only."""
    config = {"displaylogo": False, "responsive": True}
    return str(figure.to_html(full_html=False, include_plotlyjs=with_library, config=config))


def number(value: float | None, digits: int = 4) -> str:
    """A number for people; a dash where there is none."""
    return "-" if value is None else f"{value:.{digits}g}"


def interval(ends: tuple[float, float] | None) -> str:
    """Both ends of an interval; a dash where there is none."""
    return "-" if ends is None else f"{ends[0]:.4g} to {ends[1]:.4g}"


def percent(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.0f} %"


def words(name: str) -> str:
    """A name of the catalogue as words."""
    return name.replace("_", " ").replace("+", " + ")


def ties(alternatives: list[list[str]]) -> str:
    """Alternatives, each a list of names, as words."""
    return "; or ".join(" with ".join(words(name) for name in tie) for tie in alternatives)


def picture(result: Result) -> Figure:
    """Signals, errors before and after, and input, as a Matplotlib figure."""
    diagnosis, signals = result.diagnosis, result.signals
    drawn = Figure(figsize=(10, 8), layout="constrained")
    FigureCanvasAgg(drawn)
    above, before, after, driving = drawn.subplots(4, sharex=True, height_ratios=[5, 3, 3, 2])
    for name, colour in COLOURS.items():
        _draw(above, signals, name, signals[name], colour)
        if name != "measured":
            _draw(after if name == "final" else before, signals, name, signals["measured"] - signals[name], colour)
    time, values = thinned(signals["time"], signals["command"])
    driving.step(time, values, where="post", color=INPUT, linewidth=0.8)
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


def headline(diagnosis: Diagnosis) -> str:
    """Recordings, verdict and names in one line."""
    drifted = [words(name) for name, parameter in diagnosis.parameters.items() if parameter.drifted]
    named = [*(words(effect.id) for effect in diagnosis.effects), *drifted]
    what = f": {' and '.join(named)}" if named else ""
    return f"{', '.join(diagnosis.recordings)}: {words(diagnosis.verdict)}{what}"
