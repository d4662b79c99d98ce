"""What the page shows beside the document: each recording with the error of every explanation."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.motion import motion_of
from pierburg_ros.diagnosis.report.characteristics import characteristics
from pierburg_ros.diagnosis.report.tried import OFF, rivals
from pierburg_ros.diagnosis.result import Exhibits, Tried, View
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run, Switch
from pierburg_ros.inference.coordinates import without_effects
from pierburg_ros.plant import Model

Simulated = tuple[Model, Switch | None]
"""A model, and the one that takes over in the middle of a recording if there is one."""


def exhibits(found: Found, conclusion: Conclusion) -> Exhibits:
    """Every recording, the rivals of the chosen explanation, and the laws of the models."""
    held = rivals(found, conclusion)
    switch = conclusion.final.switch
    models: dict[str, Simulated] = {
        "nominal": (conclusion.nominal.model, None),
        "recalibrated": (conclusion.recalibrated.model, None),
        "final": (conclusion.model, switch),
    }
    off = switched_off(found.data, conclusion)
    models |= {row.key: (row_model, None) for row, row_model in off}
    models |= {row.key: (fit.model, fit.switch) for row, fit in held[1:] if row.key}
    numbers = list(dict.fromkeys(run.number for run in found.data.runs))
    views = tuple(_view(found.data, number, models) for number in numbers)
    tried = (*(row for row, _ in held[:1]), *(row for row, _ in off), *(row for row, _ in held[1:]))
    return Exhibits(views, tried, characteristics(found, conclusion))


def switched_off(data: Data, conclusion: Conclusion) -> list[tuple[Tried, Model]]:
    """For each effect of the final model: the model with this effect switched off, and all else unchanged."""
    rows = []
    for effect in conclusion.final.explanation.effects:
        model = without_effects(conclusion.model, [effect])
        residual = data.residual(model, conclusion.final.switch) * data.noise
        train, test = (
            float(np.sqrt(np.mean(residual[samples] ** 2))) if samples.any() else None
            for samples in (data.train, data.test)
        )
        size = conclusion.final.explanation.size - 1
        rows.append(
            (Tried(f"{OFF}{effect}", size, "rejected", train or 0.0, test, float("nan"), f"{OFF}{effect}"), model)
        )
    return rows


def _view(data: Data, number: int, models: dict[str, Simulated]) -> View:
    """One recording: its runs one after another."""
    runs = [run for run in data.runs if run.number == number]
    motions = [motion_of(run, data.actuator, data.noise) for run in runs]
    return View(
        name=runs[0].name,
        time=_joined([run.time for run in runs]),
        measured=_joined([run.measured for run in runs]),
        command=_joined([_command(run) for run in runs]),
        angle=_joined([motion.angle for motion in motions]),
        velocity=_joined([motion.velocity for motion in motions]),
        errors={
            key: _joined([run.measured - run.simulated(*simulated) for run in runs])
            for key, simulated in models.items()
        },
        left_out=tuple((*each.span, each.why) for each in data.left_out if each.number == number),
    )


def _command(run: Run) -> Signal:
    place = np.maximum(np.searchsorted(run.inputs.time, run.time, side="right") - 1, 0)
    return np.asarray(run.inputs.command[place])


def _joined(parts: list[Signal]) -> Signal:
    return np.concatenate(parts)
