"""The result where signals are not what they are read as, or tell nothing: how that shows, and how to correct it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.audit import Fault
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.schema import DataQuality, Diagnosis, Errors, FitQuality, InputFault
from pierburg_ros.inference.data import GAP
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of


def refusal(recordings: Sequence[Recording], nominal: Model, faults: Sequence[Fault]) -> Result:
    """A result that concludes nothing: verdict unexplained, no effect, no drift, the model as it was given."""
    unknown = Errors(nominal_rmse=None, recalibrated_rmse=None, final_rmse=None)
    first = recordings[0]
    document = Diagnosis(
        schema=3,
        recordings=[recording.name for recording in recordings],
        quantity=nominal.actuator.quantity,
        unit=nominal.actuator.unit,
        input=nominal.actuator.input,
        motion=nominal.actuator.motion,
        verdict="unexplained",
        locations=[],
        summary=" ".join(["Nothing is concluded.", *map(str, faults)]),
        fit=FitQuality(noise_floor=noise_of(first.time, first.measured), training=unknown, validation=unknown),
        data_quality=_quality(recordings),
        input_faults=[InputFault(**vars(fault)) for fault in faults],
        advice=[f"{fault.recording}, {fault.signal}: {fault.mend.removesuffix('.')}." for fault in faults]
        + ["Where all signals are what they are read as, go on with --force."],
    )
    return Result(document, nominal, (), _signals(first))


def _quality(recordings: Sequence[Recording]) -> DataQuality:
    """Sampling of the recordings; their motion is not judged."""
    intervals = np.concatenate([np.diff(recording.time) for recording in recordings])
    median = float(np.median(intervals))
    return DataQuality(
        rate=float(f"{1.0 / median:.6g}"),
        jitter=float(np.std(intervals[intervals <= GAP * median])),
        gaps=int(np.count_nonzero(intervals > GAP * median)),
        saturated_share=0.0,
        stops_touched=[],
        excited="not judged",
    )


def _signals(recording: Recording) -> dict[str, np.ndarray]:
    """Time [s], measured and the input of a recording; the models have no values."""
    nothing = np.full(recording.time.size, np.nan)
    return {
        "time": recording.time,
        "measured": recording.measured,
        "command": recording.command.at(recording.time, before=0.0),
        "nominal": nothing,
        "recalibrated": nothing,
        "final": nothing,
    }
