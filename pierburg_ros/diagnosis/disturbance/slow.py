"""Quantities that may wander slowly while a recording is made: an unlogged supply voltage, the zero of the sensor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.disturbance.course import Course
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

FINE = 0.1
"""Time for which a supply voltage counts as constant, in the actuator's own time. Derived: 10 ms for the valve. A
supply that changes by a volt in 3 s is then known to 2 mV, which moves the valve by half a millivolt."""
SUPPLY = 0.1
"""Usual size of a wander of the supply, as a share of it. Given: a 12 V vehicle supply has 12 to 14.5 V."""
ZERO = 0.02
"""Usual size of a wander of the sensor's zero, as a share of the travel. Chosen: a sensor with 2 % is a bad one."""

Simulated = Callable[[Model, Signal], Signal]


class Slow(Protocol):
    """A quantity that wanders slowly."""

    @property
    def usual(self) -> float:
        """Usual size of its wander, in the unit of the values at the knots."""

    def simulated(self, run: Run, course: Course) -> Simulated:
        """A function of a model and the values at the knots: the simulated signal in `run`, shape (samples,)."""

    def known(self, recording: Recording, course: Course, values: Signal) -> Recording:
        """`recording` as if the quantity had been measured."""

    def remark(self, course: Course, values: Signal) -> str:
        """The remark for the report."""


@dataclass(frozen=True)
class Supply:
    """The supply voltage, nominally `voltage` [V]; its logarithm wanders."""

    voltage: float
    own_time: float
    usual: float = SUPPLY

    def simulated(self, run: Run, course: Course) -> Simulated:
        """See `Slow`."""
        time = self._moments(run.time, run.inputs.time)
        given, basis = run.inputs.at(time), course.basis(time)

        def simulated(model: Model, values: Signal) -> Signal:
            inputs = replace(given, supply_voltage=self.voltage * np.exp(basis @ values))
            return replace(run, inputs=inputs).simulated(model)

        return simulated

    def known(self, recording: Recording, course: Course, values: Signal) -> Recording:
        """See `Slow`."""
        time = self._moments(recording.time, recording.command.time)
        supply = self.voltage * np.exp(course.basis(time) @ values)
        return replace(recording, supply_voltage=Channel(time, supply))

    def _moments(self, samples: Signal, changes: Signal) -> Signal:
        """The times [s] at which its value is set: where the input changes, and so often that it hardly moves in
        between."""
        fine = np.arange(samples[0], samples[-1], FINE * self.own_time)
        return np.unique(np.concatenate([changes, fine]))

    def remark(self, course: Course, values: Signal) -> str:
        """See `Slow`."""
        low, high = (self.voltage * float(np.exp(end(values))) for end in (np.min, np.max))
        return (
            f"The supply voltage was not logged, and seems to have wandered from {low:.3g} to {high:.3g} V, or"
            " something else that scales the motor's torque: with that, all else is explained down to the noise. Log it"
            " as supply_voltage."
        )


@dataclass(frozen=True)
class Zero:
    """The zero of the sensor, in the measured `unit`."""

    unit: str
    usual: float

    def simulated(self, run: Run, course: Course) -> Simulated:
        """See `Slow`."""
        basis = course.basis(run.time)
        last: list[tuple[Model, Signal]] = []

        def simulated(model: Model, values: Signal) -> Signal:
            if not last or last[0][0].values != model.values:
                last[:] = [(model, run.simulated(model))]
            return np.asarray(last[0][1] + basis @ values)

        return simulated

    def known(self, recording: Recording, course: Course, values: Signal) -> Recording:
        """See `Slow`."""
        return replace(recording, measured=recording.measured - course.basis(recording.time) @ values)

    def remark(self, course: Course, values: Signal) -> str:
        """See `Slow`."""
        span = float(np.ptp(values))
        return (
            f"The zero of the sensor seems to have wandered by {span:.2g} {self.unit}: with that, all else is explained"
            " down to the noise. Look at its supply, its fixing and its temperature, or log a reading at a stop."
        )
