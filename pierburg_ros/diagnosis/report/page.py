"""The report: one self-contained page with plots that can be zoomed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.actuators.units import Motion
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.report import figures
from pierburg_ros.diagnosis.report.allowed import bars
from pierburg_ros.diagnosis.report.model_file import model_text
from pierburg_ros.diagnosis.report.places import places
from pierburg_ros.diagnosis.report.tried import OFF, title
from pierburg_ros.diagnosis.result import Result, Tried, View
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.inference.evidence import SIGNIFICANT, TIED
from pierburg_ros.pages.numbers import words
from pierburg_ros.pages.over_time import OTHERS
from pierburg_ros.pages.page import NOT_FILES, Plot, Sources, written
from pierburg_ros.pages.room import page_signals

VERDICTS = {
    "consistent": "the model as described explains the recordings down to their noise",
    "parameter_drift": "the model's structure is right, its parameters have changed",
    "missing_physics": "the model lacks the effects named here, and with them it is right",
    "unexplained": "an error remains that is not explained",
}
"""The meaning of each verdict."""
NOTHING = "nothing is concluded: signals are not what they are read as, or tell nothing"
"""The meaning of a verdict where the input is at fault."""
ANGULAR = {"rad": "degrees", "rad/s": "degrees/s"}
"""Units in which people read an angle."""


def write_page(
    path: Path, result: Result, provenance: Sequence[tuple[str, str]] = (), sources: Sources = NOT_FILES
) -> None:
    """Write the report as one page that needs no network.

    `provenance` is the text on its origin; `sources` are for commands to copy.
    """
    path.write_text(page(result, provenance, sources), encoding="utf-8")


def page(
    result: Result,
    provenance: Sequence[tuple[str, str]] = (),
    sources: Sources = NOT_FILES,
    library_at: str = "",
) -> str:
    """The report as HTML; `library_at` is the address of the plotting library, if that is not part of the page."""
    diagnosis, exhibits = result.diagnosis, result.exhibits
    views = exhibits.views or (first_view(result),)
    found = places(diagnosis.locations)
    context = {
        "d": diagnosis,
        "concluded": not diagnosis.input_faults,
        "where": "As read" if diagnosis.input_faults else "Before and after",
        "meaning": NOTHING if diagnosis.input_faults else VERDICTS[diagnosis.verdict],
        "regimes": [regime_row(diagnosis, index) for index in range(len(diagnosis.regimes))],
        "places": found,
        "tried": [tried_row(row, place) for place, row in enumerate(in_colours(exhibits.tried))],
        "nothing_added": diagnosis.verdict == "consistent",
        "significant": SIGNIFICANT,
        "tie": TIED,
        "shown": 12,  # rows of a table; the others are folded away
        "few": 6,  # windows
        "over_time": time_plots(diagnosis, views, exhibits.tried),
        "residuals": residual_plots(exhibits.views, diagnosis.unit, diagnosis.motion),
        "laws": law_plots(result),
        "torques": torque_plots(diagnosis),
        "limits": limit_plots(result),
        "horizons": horizon_plots(diagnosis),
    }
    return written(
        "pierburg_ros.diagnosis.report",
        "report.html",
        page_signals([signals_of(view) for view in views], ("measured", "recalibrated", "final")),
        context,
        model_file=model_text(result),
        commands=sources.commands(
            ("See the diagnosed model beside a recording", "replay", "replayed"),
            ("Ask what it still lacks, best of a new recording", "diagnose", "again"),
        ),
        provenance=provenance,
        library_at=library_at,
    )


def time_plots(diagnosis: Diagnosis, views: Sequence[View], tried: Sequence[Tried]) -> list[Plot]:
    """Every recording over time; the located windows belong to the first."""
    plots = []
    for number, view in enumerate(views):
        found = places(diagnosis.locations) if number == 0 else []
        figure = figures.time_figure(diagnosis, view, in_colours(tried), found, str(number))
        caption = f"{view.name}: signals, errors and input over time"
        plots.append(Plot(f"time-{number}", figure, caption, 820))
    return plots


def residual_plots(views: Sequence[View], unit: str, motion: Motion) -> list[Plot]:
    """The autocorrelation of both errors, and the errors over the state."""
    if not views:
        return []
    repeated = "Autocorrelation of the errors; that of white noise is within the grey band"
    return [
        Plot("autocorrelation", figures.autocorrelation_figure(views), repeated, 320),
        Plot("over-angle", figures.state_figure(views, "angle", unit, motion), "Errors over the angle", 320),
        Plot("over-velocity", figures.state_figure(views, "velocity", unit, motion), "Errors over the velocity", 320),
    ]


def law_plots(result: Result) -> list[Plot]:
    """The laws inside the models."""
    laws = result.exhibits.characteristics
    return [Plot(f"law-{law.id}", figures.law_figure(law), law.title, 340) for law in laws]


def torque_plots(diagnosis: Diagnosis) -> list[Plot]:
    """The torque that no effect explains, over angle and velocity, and over time."""
    residual = diagnosis.residual_torque
    if residual is None:
        return []
    plots = [
        Plot(
            "torque-map",
            figures.torque_figure(residual, diagnosis.motion),
            "Missing load torque over angle and velocity",
            360,
        )
    ]
    if residual.over_time is not None:
        plots.append(
            Plot("torque-trend", figures.trend_figure(residual, diagnosis.motion), "Missing load torque over time", 360)
        )
    return plots


def limit_plots(result: Result) -> list[Plot]:
    """The largest size of each other effect that is still possible."""
    limits = bars(result.diagnosis.ruled_out, result.model)
    if not limits:
        return []
    caption = "Effects that are not named: the largest size that these recordings allow; dotted: a typical size"
    return [Plot("ruled-out", figures.bars_figure(limits), caption, figures.bars_height(limits))]


def horizon_plots(diagnosis: Diagnosis) -> list[Plot]:
    """The error over the time of a prediction."""
    horizons = diagnosis.fit.horizons
    if not horizons:
        return []
    names = ["the whole" if each.after is None else f"{each.after:g} s" for each in horizons]
    errors = {key: [getattr(each, f"{key}_rmse") for each in horizons] for key in ("nominal", "recalibrated", "final")}
    long = any(each.final_rmse is None for each in horizons if each.after is not None)
    caption = "Error of a prediction" + (
        "; heat is not measured, so the diagnosed model has one over the whole alone" if long else ""
    )
    return [Plot("horizons", figures.horizons_figure(errors, names, diagnosis.unit), caption, 320)]


def in_colours(tried: Sequence[Tried]) -> list[Tried]:
    """The explanations with the drawn ones first, so that rows and curves count their colours alike."""
    return sorted(tried, key=lambda row: row.key == "")


def tried_row(row: Tried, place: int) -> dict[str, Any]:
    """An explanation for people; the final model comes first, then those with a colour of their own."""
    off = row.name.startswith(OFF)
    return {
        "row": row,
        "name": f"diagnosed model, {title(row)}" if off else title(row),
        "colour": "final" if row.key == "final" else f"other-{(place - 1) % OTHERS}",
        "status": standing(row),
        "lack": "" if off or row.status == "chosen" else f"{row.lack:,.0f}",
        "drawn": bool(row.key),
    }


def standing(row: Tried) -> str:
    """The status of an explanation in words; one may fit better where a residual remains or time ran out."""
    if row.name.startswith(OFF):
        return "switched off, nothing fitted again"
    return "fits better, not chosen" if row.lack < -SIGNIFICANT else row.status


def regime_row(diagnosis: Diagnosis, index: int) -> dict[str, Any]:
    """A regime for people: angles in degrees, shares unchanged."""
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


def first_view(result: Result) -> View:
    """The first recording where nothing is concluded: the signals as measured, and the errors of the models."""
    signals = result.signals
    errors = {key: signals["measured"] - signals[key] for key in figures.MODELS}
    errors = {key: error for key, error in errors.items() if np.isfinite(error).all()}
    time, measured, command = (signals[name] for name in ("time", "measured", "command"))
    return View(result.diagnosis.recordings[0], time, measured, command, time[:0], time[:0], errors)


def signals_of(view: View) -> dict[str, Signal]:
    """The signals of a recording by the names that plots use."""
    return {"time": view.time, "measured": view.measured, "command": view.command, **view.errors}


def headline(diagnosis: Diagnosis) -> str:
    """Recordings, verdict and names in one line."""
    drifted = [words(name) for name, parameter in diagnosis.parameters.items() if parameter.drifted]
    named = [*(words(effect.id) for effect in diagnosis.effects), *drifted]
    what = f": {' and '.join(named)}" if named else ""
    return f"{', '.join(diagnosis.recordings)}: {words(diagnosis.verdict)}{what}"
