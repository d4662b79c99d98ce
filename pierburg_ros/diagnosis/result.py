"""What a diagnosis gives: the document, the corrected model, and signals for plots."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Result:
    """The document, the model with the named physics, the runs, and signals of the first run.

    `signals` by name, each (samples,): time [s], duty, measured, and what the nominal, the recalibrated and the final
    model make of the inputs, in the measured unit.
    """

    diagnosis: Diagnosis
    model: Model
    runs: tuple[Run, ...]
    signals: dict[str, Signal]
