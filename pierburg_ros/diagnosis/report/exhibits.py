"""What the page shows beside the document: each recording with the error of every explanation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.cleaning.cleaned import Cleaned
from pierburg_ros.diagnosis.found import Found
from pierburg_ros.diagnosis.motion import motion_of
from pierburg_ros.diagnosis.report.characteristics import characteristics
from pierburg_ros.diagnosis.report.tried import OFF, rivals, tried
from pierburg_ros.diagnosis.result import Exhibits, Tried, View
from pierburg_ros.inference.coordinates import without_effects
from pierburg_ros.inference.data import Run


def exhibits(found: Found, cleaned: Sequence[Cleaned]) -> Exhibits:
    """Every recording, the rivals of the chosen explanation, and the laws of the models."""
    rows, off = rivals(found), switched_off(found)
    errors = found.errors | {row.key: residual for row, residual in (*off, *rows) if row.key}
    by_run = {key: found.data.by_run(residual) for key, residual in errors.items()}
    views = tuple(
        _view(found, run, {key: parts[number] for key, parts in by_run.items()}, each)
        for number, (run, each) in enumerate(zip(found.data.runs, cleaned, strict=True))
    )
    return Exhibits(views, tuple(row for row, _ in (*rows[:1], *off, *rows[1:])), characteristics(found))


def switched_off(found: Found) -> list[tuple[Tried, Signal]]:
    """For each effect of the model that is handed out: what it leaves without this effect, all else unchanged."""
    rows, own = [], found.written
    for effect in own.explanation.effects:
        model = without_effects(own.model, [effect])
        after = own.after and without_effects(own.after, [effect])
        residual = own.fitter.replaying.residual(model, after, own.when) * found.data.noise
        key = f"{OFF}{effect}"
        rows.append((tried(found, residual, key, own.size - 1, "rejected", math.nan, key), residual))
    return rows


def _view(found: Found, run: Run, errors: Mapping[str, Signal], cleaned: Cleaned) -> View:
    """One recording with the error of every model."""
    motion = motion_of(run, found.data.actuator, found.data.noise)
    return View(
        name=run.name,
        time=run.time,
        measured=run.measured,
        command=run.in_force,
        angle=motion.angle,
        velocity=motion.velocity,
        errors=dict(errors),
        left_out=tuple(cleaned.left_out(found.data.actuator)),
    )
