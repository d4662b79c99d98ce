"""The work on one recording, where a worker does it: diagnosed, and later measured with the model of its fleet."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError, one_line
from pierburg_ros.fleets.recordings.place import at_hand, digest
from pierburg_ros.fleets.recordings.units import Source
from pierburg_ros.fleets.task import Task
from pierburg_ros.identification.fit import fit
from pierburg_ros.library.diagnosing import Diagnosis, diagnose
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

LIBRARY = "../../plotly.min.js"
"""Where a recording's report finds the plotting library, which all reports of a fleet share."""
DEVIATIONS_95 = 1.959963984540054
"""Standard deviations to either side that hold 95 % of a normal distribution. Given: the quantile of its table."""


@dataclass(frozen=True)
class Outcome:
    """What is known of a recording: the `key` of its result, the result, and its files as text by name.

    `result` is None where it was known before. `begun` is when its first sample was measured [s since 1970].
    """

    key: str
    result: dict[str, Any] | None
    files: Mapping[str, str] = field(default_factory=dict)


def examined(source: Source, task: Task, known: frozenset[str] = frozenset()) -> Outcome:
    """The diagnosis of a recording, unless its key is `known`; a recording that cannot be used gives the reason."""
    key = ""
    try:
        with at_hand(source.path) as path:
            key = task.key(digest(path))
            if key in known:
                return Outcome(key, None)
            began = time.process_time()
            recording = task.read(path)
            found = diagnose(recording, model=task.nominal, jobs=1, budget=task.budget)
            files = _files(found, task.results / key)
            result = {**_said(found, recording), "processor_time": time.process_time() - began}
            return Outcome(key, result, files)
    except (InputError, OSError) as error:
        return Outcome(key, {"problem": one_line(str(error))})
    except Exception as error:  # a fault of this package or of a library must not end the fleet
        return Outcome(key, {"problem": one_line(f"the diagnosis failed: {type(error).__name__}: {error}")})


def _files(found: Diagnosis, folder: Path) -> dict[str, str]:
    """The files of a diagnosis that is kept in a `folder`, the report without the plotting library."""
    from pierburg_ros.diagnosis.report.model_file import model_text
    from pierburg_ros.diagnosis.report.page import page
    from pierburg_ros.library.origin import origin

    known = origin(found.model.actuator, found.recordings, folder / "model.yaml")
    report = page(found.found, *known, library_at=LIBRARY)
    return {"diagnosis.json": found.to_json(), "model.yaml": model_text(found.found), "report.html": report}


def _said(found: Diagnosis, recording: Recording) -> dict[str, Any]:
    """What a table says of a diagnosis."""
    said = found.document
    parameters = [
        _finding("parameter", name, each.value, each.ci95, each.unit, each.identifiable)
        for name, each in said.parameters.items()
        if each.drifted
    ]
    effects = [
        _finding(
            "effect", f"{effect.id}.{name}", each.value, each.ci95, each.unit, each.identifiable, effect.confidence
        )
        for effect in said.effects
        for name, each in effect.parameters.items()
    ]
    limits = [
        _finding("ruled_out", f"{each.id}.{each.parameter}", None, (each.above, each.below), each.unit, True)
        for each in said.ruled_out
    ]
    return {
        "problem": None,
        "begun": _begun(recording),
        "duration": recording.duration,
        "samples": int(recording.time.size),
        "temperature": _mean(recording.temperature),
        "supply_voltage": _mean(recording.supply_voltage),
        "verdict": said.verdict,
        "stopped": said.effort.stopped_by is not None,
        "summary": said.summary,
        "faults": [f"{fault.signal}: {fault.what}" for fault in said.input_faults],
        "noise_floor": said.fit.noise_floor,
        "nominal_rmse": said.fit.training.nominal_rmse,
        "final_rmse": said.fit.training.final_rmse,
        "findings": [*parameters, *effects, *limits],
    }


def _finding(
    kind: str,
    name: str,
    value: float | None,
    ends: tuple[float | None, float | None] | None,
    unit: str,
    identifiable: bool,
    confidence: float | None = None,
) -> dict[str, Any]:
    low, high = ends or (None, None)
    numbers = {"value": value, "low": low, "high": high, "confidence": confidence}
    return {"kind": kind, "name": name, "unit": unit, "identifiable": identifiable, **numbers}


def _begun(recording: Recording) -> float | None:
    """When the first sample was sent, as its file tells [s since 1970]; None where it does not."""
    return None if recording.file_times is None else 1e-9 * float(recording.file_times.publish_time[0])


def _mean(channel: Channel | None) -> float | None:
    return None if channel is None else float(np.mean(channel.values))


@dataclass(frozen=True)
class Measurement:
    """A recording to be measured: its diagnosed effects by dotted value, and the quantities to be measured."""

    source: Source
    key: str
    effects: Mapping[str, float]
    names: tuple[str, ...]


def measured(asked: Measurement, task: Task) -> dict[str, Any]:
    """Value, standard deviation and whether it is determined of each quantity, fitted together to one recording.

    The model is the nominal one with the recording's own effects. None where it cannot be fitted.
    """
    try:
        with at_hand(asked.source.path) as path:
            recording = task.read(path)
        model: Model = task.nominal.with_values(asked.effects)
        found = fit(model, [recording], asked.names, jobs=1)
    except (InputError, OSError, np.linalg.LinAlgError) as error:
        return {"problem": one_line(str(error)), "values": {}}
    values = {}
    for name, undetermined in zip(found.names, found.covariance.undetermined, strict=True):
        low, high = found.ci95[name]
        values[name] = {
            "value": found.values[name],
            "deviation": (high - low) / (2.0 * DEVIATIONS_95),
            "determined": bool(not undetermined and math.isfinite(high - low)),
        }
    return {"problem": None, "values": values}
