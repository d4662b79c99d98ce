"""What a diagnosis gives: the document, the corrected model, and signals for plots."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Diagnosis, Status
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class View:
    """One recording as plots show it; all signals of shape (samples,).

    `errors` are measured less simulated in the measured unit, by what was simulated: `nominal`, `recalibrated`,
    `final`, and the `key` of each `Tried` that is drawn. `angle` [rad] is read by the nominal sensor, `velocity`
    [rad/s] with it. `left_out` are spans [s] that no model was held against, with the reason.
    """

    name: str
    time: Signal
    measured: Signal
    command: Signal
    angle: Signal
    velocity: Signal
    errors: dict[str, Signal]
    left_out: tuple[tuple[float, float, str], ...] = ()


@dataclass(frozen=True)
class Tried:
    """An explanation beside the chosen one: how many quantities it changes, and what it leaves.

    Errors are root mean squares in the measured unit on samples that were fitted and that were not. `lack` is what it
    fits worse than the chosen one, in chi2 of independent samples; `key` names its error in a `View`, if drawn.
    """

    name: str
    size: int
    status: Status
    training: float
    unseen: float | None
    lack: float
    key: str = ""


@dataclass(frozen=True)
class Characteristic:
    """A law inside the actuator: `curves` (x, y) by model, and the recordings' say as `points` (x, y) around the final.

    A point is the final curve plus what the recording lacks there (a partial residual).
    """

    id: str
    title: str
    x: str
    y: str
    curves: dict[str, tuple[Signal, Signal]]
    points: tuple[Signal, Signal] | None = None


@dataclass(frozen=True)
class Exhibits:
    """What the page shows beside the document: every recording, the explanations held against each other, the laws."""

    views: tuple[View, ...] = ()
    tried: tuple[Tried, ...] = ()
    characteristics: tuple[Characteristic, ...] = ()


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
    exhibits: Exhibits = Exhibits()
