"""From recordings to a diagnosis: the whole path in one function."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.diagnosis.evidence import quality
from pierburg_ros.diagnosis.evidence.data import EvidenceData, Run, evidence_of
from pierburg_ros.diagnosis.evidence.motion import motion_of
from pierburg_ros.diagnosis.location.locations import locations
from pierburg_ros.diagnosis.location.regimes import regimes
from pierburg_ros.diagnosis.location.windows import windows
from pierburg_ros.diagnosis.report import findings
from pierburg_ros.diagnosis.report.words import advice, summary
from pierburg_ros.diagnosis.schema import Diagnosis, Location, Regime, ResidualTorque, TorqueOverTime
from pierburg_ros.diagnosis.search.explanation import Explanation
from pierburg_ros.diagnosis.search.explore import Exploration, Progress, explored
from pierburg_ros.diagnosis.search.intervals import estimates
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion, conclude
from pierburg_ros.diagnosis.verdict.recalibrations import recalibrations
from pierburg_ros.diagnosis.verdict.residual_shape import Shape, fit_shape
from pierburg_ros.diagnosis.verdict.shared import select
from pierburg_ros.effects import EFFECT
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

Signal = NDArray[np.float64]

CONFIRMED = 0.9
"""Share of the error on unseen data to which a residual torque must bring it to be kept."""


@dataclass(frozen=True)
class Result:
    """The document, the model with the named physics, the runs, and signals of the first run for plots."""

    diagnosis: Diagnosis
    model: Model
    runs: tuple[Run, ...]
    signals: dict[str, Signal]


def diagnose(
    recordings: Sequence[Recording],
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
) -> Result:
    """Locate, name and model what `nominal` lacks, from recordings alone.

    `progress` is told what is being tried; `jobs` is the number of fits at a time, by default one for each core.
    InputError where the recordings cannot be used.
    """
    quality.refuse_unusable(recordings)
    exploration = explored(evidence_of(recordings, nominal.actuator), nominal, progress)
    data = exploration.data
    conclusion = conclude(exploration)
    shape = None
    if conclusion.verdict == "unexplained":
        conclusion, shape = _beyond_the_catalogue(exploration, conclusion, progress)
    model = shape.model if shape is not None else conclusion.final.model
    document = _document(recordings, exploration, conclusion, shape)
    return Result(document, model, data.runs, _signals(data.runs[0], conclusion, model))


def _beyond_the_catalogue(
    exploration: Exploration, conclusion: Conclusion, progress: Progress
) -> tuple[Conclusion, Shape | None]:
    """What can be said where no explanation accounts for all.

    Several recordings can vouch for effects that each lower the error on recordings left out; one recording
    cannot. What is then left is fitted as a torque over angle and velocity, kept where unseen data confirm it.
    """
    data, search = exploration.data, exploration.search
    if len(data.runs) > 1:
        shared = select(exploration, conclusion.recalibrated)
        base, supports = search.linearised(shared.fit), shared.supports
        shape = fit_shape(data, [lambda _: base.model], progress)
    else:
        explanation = conclusion.recalibrated.explanation
        shape = fit_shape(data, recalibrations(exploration.nominal, explanation), progress)
        drifted = Explanation() if shape.base is exploration.nominal else explanation
        base, supports = search.fit(drifted, shape.base.values, 0), {}
    known = estimates(search, base)
    reopened = replace(conclusion, chosen=base, final=base, alternatives=[], estimates=known, supports=supports)
    return reopened, shape if shape.after < CONFIRMED * shape.before else None


def _document(
    recordings: Sequence[Recording], exploration: Exploration, conclusion: Conclusion, shape: Shape | None
) -> Diagnosis:
    data, final = exploration.data, conclusion.final
    model = shape.model if shape is not None else final.model
    effects = findings.effects(conclusion)
    parameters = findings.parameters(exploration, conclusion)
    sampling = quality.data_quality(data.runs, data.actuator, data.noise)
    fit = findings.fit_quality(exploration, conclusion, model)
    changes = findings.changes(final)
    hidden = findings.not_testable(exploration, conclusion)
    places, ranges = _located(data, conclusion)
    limits = quality.limits_of(data.runs, data.actuator, data.noise)
    return Diagnosis(
        schema=1,
        recordings=[recording.name for recording in recordings],
        quantity=data.actuator.quantity,
        unit=data.actuator.unit,
        verdict=conclusion.verdict,
        summary=_cautioned(limits, summary(conclusion.verdict, effects, parameters, changes, fit, data.actuator.unit)),
        effects=effects,
        parameters=parameters,
        changes=changes,
        locations=places,
        regimes=ranges,
        fit=fit,
        candidates=findings.candidates(exploration, conclusion),
        not_testable=hidden,
        residual_torque=_residual_torque(shape),
        data_quality=sampling,
        advice=advice(conclusion.verdict, effects, parameters, hidden, limits),
    )


def _cautioned(limits: Sequence[quality.Limit], text: str) -> str:
    """The summary, or, where the recordings cannot decide anything, why not."""
    decisive = [limit.finding for limit in limits if limit.decisive]
    return f"Nothing can be concluded: {' '.join(decisive)} {text}" if decisive else text


def _located(data: EvidenceData, conclusion: Conclusion) -> tuple[list[Location], list[Regime]]:
    """Windows and regimes of the first recording in which the mismatch gathers; none where there is none.

    Windows are where the named effects move the signal, or, where none is named, where the error is.
    """
    if conclusion.verdict in ("consistent", "parameter_drift"):
        return [], []
    run, final = data.runs[0], conclusion.final
    motion = motion_of(run, data.actuator, data.noise)
    residual = run.measured - run.simulated(conclusion.recalibrated.model)
    mark = residual
    if final.explanation.variants:
        bare = final.model.with_values(
            {f"{v.effect}.{name}": 0.0 for v in final.explanation.variants for name in EFFECT[v.effect].names}
        )
        mark = run.simulated(final.model, final.switch) - run.simulated(bare)
    found = windows(motion.time, mark**2)
    return locations(motion, residual, found), regimes(motion, residual)


def _residual_torque(shape: Shape | None) -> ResidualTorque | None:
    if shape is None or shape.model.residual_torque is None:
        return None
    grid = {key: np.asarray(shape.model.residual_torque[key]).tolist() for key in ("angle", "velocity", "torque")}
    time, torque = shape.over_time
    return ResidualTorque(
        **grid, shape=shape.words, over_time=TorqueOverTime(time=time.tolist(), torque=torque.tolist())
    )


def _signals(run: Run, conclusion: Conclusion, model: Model) -> dict[str, Signal]:
    """Time [s], measured, duty, and what the three models make of the first run, each (samples,)."""
    place = np.maximum(np.searchsorted(run.inputs.time, run.time, side="right") - 1, 0)
    return {
        "time": run.time,
        "measured": run.measured,
        "duty": run.inputs.duty[place],
        "nominal": run.simulated(conclusion.nominal.model),
        "recalibrated": run.simulated(conclusion.recalibrated.model),
        "final": run.simulated(model, conclusion.final.switch),
    }
