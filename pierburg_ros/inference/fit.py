"""Fits of explanations by a simulation that is pulled to the recordings, first strongly, then ever more weakly.

Whole simulations have costs with many local minima: one slip at the wrong moment displaces all that follows. Pulled
with a time constant it costs for that long. So a fit begins where the time constant is the actuator's own time, and
goes on with longer ones (homotopy in the parameter: Vyasarayani, Uchida, McPhee, Single-shooting homotopy method for
parameter identification in dynamical systems, 2012).
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from threading import Lock
from typing import Any, Literal

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.budget import USUAL_BUDGET, Budget, OutOfTime
from pierburg_ros.errors import InputError
from pierburg_ros.inference.coordinates import ENDS, STARTS, Coordinates, in_order
from pierburg_ros.inference.data import FORMULATION, Data, Run
from pierburg_ros.inference.evidence import EXPLAINED, SIGNIFICANT, beyond, repetition, structure
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation
from pierburg_ros.inference.least_squares import FULL, Solution, jacobian, minimise
from pierburg_ros.plant import Model
from pierburg_ros.plant.braking import braking
from pierburg_ros.plant.decode import begun, decoded_value
from pierburg_ros.plant.following import Pull, follow

UNSIMULATED = 1e3
"""Error [noise] where a model cannot be simulated. Chosen: more than any model leaves that can be."""
WILD = 1e6
"""Largest error [noise] that is told. Derived: its square, summed over a day at 1 kHz, is 1e20; an unstable simulation
reaches values whose squares are no numbers."""
SHORTEST_PULL = 8.0
"""Least time constant in sample periods. Derived: two samples for each of the four pulls in a time constant."""
LADDER = (1.0, 3.0, 10.0)
"""Time constants of the pull in the actuator's own time, one after the other. Chosen: from where costs are smooth to
what the valve remembers, 0.1 to 1 s; not varied."""


@dataclass
class Effort:
    """How many simulations were made of those that a budget allows: a count of work that no machine's speed changes."""

    budget: Budget = USUAL_BUDGET
    simulations: int = 0
    stopped_by: Literal["budget", "interrupt", "clock"] | None = None
    _interruptible: bool = field(default=False, repr=False)
    _begun: float = field(default_factory=time.monotonic, repr=False)
    _lock: Lock = field(default_factory=Lock, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """For copies, each of which has a lock of its own."""
        return {name: value for name, value in vars(self).items() if name != "_lock"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _lock=Lock())

    def count(self) -> None:
        """One more; OutOfTime where the time is over during `interruptible` work."""
        with self._lock:
            self.simulations += 1
            if self._interruptible and time.monotonic() - self._begun >= self.budget.seconds:
                raise OutOfTime

    @property
    def over(self) -> bool:
        """Whether nothing larger may be tried.

        The count is looked at between the steps of a search, so that it ends at the same step with any number of jobs.
        """
        if self.stopped_by is None and self.simulations >= self.budget.simulations:
            self.stopped_by = "budget"
        return self.stopped_by is not None

    @contextmanager
    def interruptible(self) -> Iterator[None]:
        """Work that Ctrl-C or the end of the time may end, with what was found before."""
        self._interruptible = True
        try:
            yield
        except OutOfTime:
            self.stopped_by = "clock"
        except KeyboardInterrupt:
            self.stopped_by = "interrupt"
        finally:
            self._interruptible = False


@dataclass(frozen=True)
class Fit:
    """An explanation with its best values by dotted name.

    `residual` is measured minus simulated over all runs, shape (samples,), in units of the noise; `after` the model
    that takes over in mid-recording, if any.
    """

    explanation: Explanation
    values: dict[str, float]
    model: Model
    after: Model | None
    residual: Signal = field(repr=False)
    solution: Solution = field(repr=False)
    fitter: Fitter = field(repr=False)

    @property
    def size(self) -> int:
        """Number of quantities that it changes."""
        return self.explanation.size

    @property
    def when(self) -> float:
        """When the second model takes over [s]; infinite where there is none."""
        changed = self.explanation.changed
        return math.inf if changed is None else self.values[changed + WHEN]

    @cached_property
    def fitted(self) -> Signal:
        """The residual of the samples that were fitted, without what a coarse converter accounts for."""
        data = self.fitter.data
        return beyond(self.residual[data.train], data.half_step)

    @property
    def chi2(self) -> float:
        """Sum of squares of the fitted residual."""
        return float(self.fitted @ self.fitted)

    @cached_property
    def ratio(self) -> float:
        """Fitted error over the noise, root mean square."""
        return self.ratio_of(self.fitter.data.train)

    def ratio_of(self, samples: Flags) -> float:
        """The same of some samples; 0 where there are none."""
        left = beyond(self.residual[samples], self.fitter.data.half_step)
        return math.sqrt(float(np.mean(np.square(left))) + self.rounding) if left.size else 0.0

    @property
    def rounding(self) -> float:
        """Mean square error [noise^2] of a coarse converter, which no fit sees; 0 where steps are fine."""
        return self.fitter.data.half_step**2 / 3.0

    @cached_property
    def replayed(self) -> Signal:
        """The same as `residual`, by the simulation of a replay: what somebody sees who is handed the model."""
        return self.fitter.replaying.left_by(self)

    @cached_property
    def repetition(self) -> float:
        """Number of fitted samples that count as one."""
        return repetition(self.fitted)

    @cached_property
    def structure(self) -> float:
        """Evidence in the fitted residual for an error that is correlated in time, in -2 log likelihood."""
        data = self.fitter.data
        return structure(self.fitted, math.hypot(self.fitter.unlike, data.rounding / data.noise))

    @cached_property
    def basis(self) -> Signal:
        """Orthonormal basis of what small changes of its values do to the fitted residual, (samples, quantities)."""
        return self.solution.basis

    @cached_property
    def slopes(self) -> Signal:
        """Derivative of the fitted residual by coordinate, shape (samples, quantities)."""
        return self.solution.jacobian


@dataclass(frozen=True, eq=False)
class Fitter:
    """Fits models of `nominal` to `data` with a pull of time `constant` [s]; infinite for none."""

    data: Data
    nominal: Model
    constant: float
    effort: Effort = field(default_factory=Effort)

    def pulled(self, constant: float) -> Fitter:
        """The same with another time `constant` [s]."""
        return replace(self, constant=constant)

    @property
    def replaying(self) -> Fitter:
        """The same with the pull of a replay."""
        return self.pulled(pull_of(self.data.actuator, self.data.period))

    @cached_property
    def pulls(self) -> tuple[Pull, ...]:
        """The pull on each run: until it has settled, as strong as the first of the ladder at least."""
        inertial = inertia_time(self.nominal) > self.data.period and self.data.actuator.quantity != "speed"
        first = min(ladder(self.data)[0], self.constant)
        return tuple(
            Pull.every(run.time, np.where(run.settled, self.constant, first), inertial) for run in self.data.runs
        )

    @cached_property
    def unlike(self) -> float:
        """Error [noise, root mean square] that lasts and is no evidence: what two correct simulators differ by."""
        return FORMULATION * self.data.scales.reading / self.data.noise

    def residual(self, model: Model, after: Model | None = None, when: float = math.inf) -> Signal:
        """Measured minus simulated over all runs, in units of the noise; `after` takes over `when` [s] it is time."""
        parts = []
        for run, pull in zip(self.data.runs, self.pulls, strict=True):
            self.effort.count()
            start = beginning(run, model)
            simulated = follow(model, run.inputs, run.time, run.measured, start, pull, after, when)
            parts.append(run.measured - simulated)
        left = np.concatenate(parts) / self.data.noise
        unknown = np.flatnonzero(~np.isfinite(left))
        left[unknown] = UNSIMULATED * (1.0 - 2.0 * (unknown % 2))
        return np.asarray(np.clip(left, -WILD, WILD))

    def moment(self, model: Model, after: Model) -> float:
        """When [s] `after` had best take over from `model` in the only run: a fit moves a moment by samples."""
        return float(self.data.runs[0].time[int(np.argmin(self.gained(model, after)))])

    def span(self, absent: Model, present: Model) -> tuple[float, float]:
        """From when to when [s] `present` had best act in place of `absent` in the only run; 0: its beginning or end.

        The stretch over which the sum of what it gains is largest.
        """
        gained = np.concatenate([[0.0], self.gained(absent, present)])
        end = int(np.argmax(gained - np.minimum.accumulate(gained)))
        start, time = int(np.argmin(gained[: end + 1])), self.data.runs[0].time
        return (float(time[start]) if start else 0.0), (float(time[end]) if end < time.size else 0.0)

    def gained(self, model: Model, other: Model) -> Signal:
        """By how much an `other` model leaves less of the fitted samples up to each, shape (samples,)."""
        before, later = (np.square(beyond(self.residual(each), self.data.half_step)) for each in (model, other))
        return np.cumsum(np.where(self.data.train, before - later, 0.0))

    def coordinates(self, explanation: Explanation) -> Coordinates:
        """The coordinates in which the quantities of an explanation are searched."""
        return Coordinates(explanation.names, self.nominal, self.data.duration)

    def models(self, explanation: Explanation, values: Mapping[str, float]) -> tuple[Model, Model | None, float]:
        """The model with some values, the one that takes over, and when [s]; InputError where none can have them."""
        own = {**values, **explanation.fixed}
        base = in_order({name: value for name, value in own.items() if "@" not in name}, self.nominal)
        model, changed = self.nominal.with_values(base), explanation.changed
        if changed is None:
            return model, None, math.inf
        return (
            model,
            model.with_values(in_order({**base, changed: own[changed + AFTER]}, self.nominal)),
            own[changed + WHEN],
        )

    def fitted(self, explanation: Explanation, values: Mapping[str, float]) -> Signal:
        """The residual of the samples that are fitted, as `Fit.fitted`; InputError where no model can have `values`."""
        return beyond(self.residual(*self.models(explanation, values))[self.data.train], self.data.half_step)

    def left_by(self, fit: Fit) -> Signal:
        """`residual` of the model of a fit that another fitter may have made."""
        return self.residual(fit.model, fit.after, fit.when)

    def fit(self, explanation: Explanation, values: Mapping[str, float], iterations: int = FULL) -> Fit:
        """The best values of an explanation from some `values` on, others held there, by so many `iterations`."""
        coordinates, given = self.coordinates(explanation), {**self.nominal.values, **values}
        size = int(np.count_nonzero(self.data.train))

        def fitted(point: Signal) -> Signal:
            try:
                return self.fitted(explanation, {**given, **coordinates.values(point)})
            except InputError:
                return np.full(size, UNSIMULATED)

        found = minimise(fitted, coordinates.point(given), *coordinates.bounds, coordinates.steps, iterations)
        best = self.lasting({**given, **explanation.fixed, **coordinates.values(found.point)})
        model, after, when = self.models(explanation, best)
        best.update(model.values)
        return Fit(explanation, best, model, after, self.residual(model, after, when), found, self)

    def lasting(self, values: dict[str, float]) -> dict[str, float]:
        """`values` in which what no sample shows ending has no end, and what none shows beginning no beginning."""
        first, last = self.data.shown
        early = (name for name in STARTS if values[name] <= first)
        return values | dict.fromkeys((*early, *(name for name in ENDS if values[name] >= last)), 0.0)

    def slopes(self, fit: Fit, explanation: Explanation) -> Signal:
        """Derivative of the fitted residual by the coordinates of another `explanation` at the values of `fit`."""
        coordinates = self.coordinates(explanation)

        def fitted(point: Signal) -> Signal:
            return self.fitted(explanation, {**fit.values, **coordinates.values(point)})

        point = coordinates.point(fit.values)
        return jacobian(fitted, point, fitted(point), *coordinates.bounds, coordinates.steps)


def ladder(data: Data) -> tuple[float, ...]:
    """The time constants of the pull [s], one after the other: multiples of the actuator's own, of samples at least."""
    return rungs(data.actuator, data.period)


def rungs(actuator: Actuator, period: float) -> tuple[float, ...]:
    """The same for an actuator and samples a `period` [s] apart.

    What forgets nothing does not forget where its simulation began either: it keeps to the first.
    """
    own = max(actuator.scales.time, SHORTEST_PULL * period)
    return tuple(rung * own for rung in (LADDER if actuator.forgets else LADDER[:1]))


def pull_of(actuator: Actuator, period: float) -> float:
    """Time constant [s] with which a replay is pulled to samples a `period` [s] apart; infinite where none is needed.

    A pendulum or a free rotor driven by a current or a torque forgets nothing. Its simulation drifts from any recording
    for ever, so it is pulled with the actuator's own time.
    """
    return math.inf if actuator.forgets else rungs(actuator, period)[0]


def strongest(fitter: Fitter) -> Fitter:
    """The same fitter with the first pull of the ladder."""
    return fitter.pulled(ladder(fitter.data)[0])


def inertia_time(model: Model) -> float:
    """Time [s] in which friction that grows with speed and back-EMF stop a shaft; infinite without any."""
    brake = braking(model)
    return model.values.get("total_inertia", 0.0) / brake if brake > 0.0 else math.inf


def adequate(fit: Fit) -> bool:
    """Whether a fit leaves only noise, of a size that may be estimated too low, and nothing correlated in time."""
    return fit.ratio < EXPLAINED and fit.structure < SIGNIFICANT


def excess(fit: Fit) -> float:
    """Mean square [noise^2] that a fit leaves above the noise; 0 where it leaves nothing but noise."""
    return 0.0 if adequate(fit) else max(fit.ratio**2 - 1.0, 0.0)


def rms_of(fit: Fit, samples: Flags) -> float:
    """Root mean square that a replay leaves of some samples, in the measured unit; not a number without any."""
    left = fit.replayed[samples]
    return float(np.sqrt(np.mean(np.square(left)))) * fit.fitter.data.noise if left.size else math.nan


def beginning(run: Run, model: Model) -> Signal:
    """Angle [rad], velocity [rad/s], acceleration [rad/s^2] and way of coming at the first sample."""
    if run.quantity != "speed":
        return np.asarray(begun(model, run.shown[np.newaxis], run.quantity)[0])
    velocity = decoded_value(model, float(run.shown[0]), run.quantity)
    return np.array([rest_angle(model), velocity, 0.0, 0.0])


def rest_angle(model: Model) -> float:
    """Angle at which an actuator without input rests [rad]: on its stop, at the end of its spring, or hanging down."""
    value, actuator = model.values, model.actuator
    stiffness = value.get("spring_stiffness", 0.0)
    relaxed = -value.get("spring_preload", 0.0) / stiffness if stiffness > 0.0 else 0.0
    return min(max(relaxed, actuator.lower_stop), actuator.upper_stop)
