"""The result of a diagnosis: the document, the corrected model, and signals for plots."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Diagnosis, Status
from pierburg_ros.inference.data import Run
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class View:
    """One recording as plots show it; all signals of shape (samples,).

    `errors` are measured minus simulated in the measured unit, by the model simulated: `nominal`, `recalibrated`,
    `final`, and the `key` of each `Tried` that is drawn. `angle` [rad] and `velocity` [rad/s] are those that the
    nominal sensor reads. `left_out` are spans [s] that no model was compared with, each with the reason.
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
    """An explanation compared with the chosen one: how many quantities it changes, and the error that it leaves.

    Errors are root mean squares in the measured unit, `training` on samples that were fitted, `unseen` on samples that
    were not. `lack` is how much worse it fits than the chosen one, in chi2 of independent samples. `key` names its
    error in a `View`, if drawn.
    """

    name: str
    size: int
    status: Status
    training: float
    unseen: float | None
    lack: float
    key: str = ""


@dataclass(frozen=True)
class Points:
    """Means of what recordings show along `x`, and `error`, the half of their 95 % intervals, each shape (points,)."""

    x: Signal
    y: Signal
    error: Signal


@dataclass(frozen=True)
class Characteristic:
    """A law inside the actuator: `curves` (x, y) by model, and `points` of the recordings around the final.

    A point is the mean of the final curve plus the residual of the balance there (a partial residual).
    """

    id: str
    title: str
    x: str
    y: str
    curves: dict[str, tuple[Signal, Signal]]
    points: Points | None = None


@dataclass(frozen=True)
class Exhibits:
    """What the page shows beside the document: every recording, the explanations compared, and the laws."""

    views: tuple[View, ...] = ()
    tried: tuple[Tried, ...] = ()
    characteristics: tuple[Characteristic, ...] = ()


@dataclass(frozen=True)
class Result:
    """The document, the model with the named physics, the runs, and signals of one run.

    `signals` are those of the first recording by name, each (samples,): time [s], duty, measured.
    The simulations by the nominal, the recalibrated and the final model are in the measured unit.
    """

    diagnosis: Diagnosis
    model: Model
    runs: tuple[Run, ...]
    signals: dict[str, Signal]
    exhibits: Exhibits = Exhibits()
