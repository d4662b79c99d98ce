"""What the page shows beside the document: each recording with the error of every explanation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.cleaning.cleaned import Cleaned
from pierburg_ros.diagnosis.found import Found, when_of
from pierburg_ros.diagnosis.motion import motion_of
from pierburg_ros.diagnosis.report.characteristics import characteristics
from pierburg_ros.diagnosis.report.tried import OFF, rivals, rms
from pierburg_ros.diagnosis.result import Exhibits, Tried, View
from pierburg_ros.inference.coordinates import without_effects
from pierburg_ros.inference.data import Run


def exhibits(found: Found, cleaned: Sequence[Cleaned]) -> Exhibits:
    """Every recording, the rivals of the chosen explanation, and the laws of the models."""
    rows, choice = rivals(found), found.choice
    errors = {"nominal": found.residual(choice.described), "recalibrated": found.residual(choice.estimated)}
    errors["final"] = found.residual(found.written)
    off = switched_off(found)
    errors |= {row.key: residual for row, residual in off}
    errors |= {row.key: found.residual(fit) for row, fit in rows if row.key and row.key not in errors}
    views = tuple(_view(found, run, errors, each) for run, each in zip(found.data.runs, cleaned, strict=True))
    tried = (*(row for row, _ in rows[:1]), *(row for row, _ in off), *(row for row, _ in rows[1:]))
    return Exhibits(views, tried, characteristics(found))


def switched_off(found: Found) -> list[tuple[Tried, Signal]]:
    """For each effect of the model that is handed out: what it leaves without this effect, all else unchanged."""
    rows, data, own = [], found.data, found.written
    for effect in own.explanation.effects:
        model = without_effects(own.model, [effect])
        after = own.after and without_effects(own.after, [effect])
        residual = found.shown.residual(model, after, when_of(own)) * data.noise
        unseen = residual[data.test]
        key = f"{OFF}{effect}"
        row = Tried(
            key,
            own.size - 1,
            "rejected",
            rms(residual[data.train]),
            rms(unseen) if unseen.size else None,
            math.nan,
            key,
        )
        rows.append((row, residual))
    return rows


def _view(found: Found, run: Run, errors: Mapping[str, Signal], cleaned: Cleaned) -> View:
    """One recording with the error of every model."""
    motion = motion_of(run, found.data.actuator, found.data.noise)
    first = float(cleaned.recording.time[0])
    spans = [
        (start - first, end - first, "the input is unknown there") for start, end in cleaned.recording.unknown_input
    ]
    spans += [(each.span[0] - first, each.span[1] - first, each.why) for each in cleaned.omissions]
    return View(
        name=run.name,
        time=run.time,
        measured=run.measured,
        command=run.in_force,
        angle=motion.angle,
        velocity=motion.velocity,
        errors={key: np.asarray(found.of_run(residual, run)) for key, residual in errors.items()},
        left_out=tuple(spans),
    )
