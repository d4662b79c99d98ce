"""A simulation that follows a recording: again and again it is moved a little towards what was measured.

Pulled with a time constant, an error of the model or a slip at the wrong moment costs for that long, and not for all
that comes after it; the longer the time constant, the nearer to a free run. It is the observer of Luenberger, Observing
the state of a linear system (1964); fits by it: Abarbanel, Creveling, Farsian, Kostuk, Dynamical state and parameter
estimation (2009).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.plant.model import Model
from pierburg_ros.plant.simulate import Inputs, begin, channels, run
from pierburg_ros.plant.state import blank_state, displace, place, turn
from pierburg_ros.plant.torques.sensor import SPEED

PULLS = 4.0
"""Pulls in a time constant. Derived: a pull then moves the simulation by a fifth of its error, as one that pulls all
the time would."""


@dataclass(frozen=True)
class Pull:
    """When a simulation is pulled, and how far: after the samples `last`, shape (pulls,), increasing.

    `angle` and `rate` [1/s] are what the state takes of the mean error of the samples from `seen` on up to the last.
    """

    last: NDArray[np.int64]
    seen: NDArray[np.int64]
    angle: Signal
    rate: Signal

    @staticmethod
    def every(time: Signal, constant: float | Signal, inertial: bool) -> Pull:
        """Pulls with a time `constant` [s], infinite for none, on samples at each `time` [s], both shape (samples,).

        Of an `inertial` shaft the velocity is pulled too, with both poles of the error at the time constant.
        """
        # time in time constants
        passed = np.concatenate([[0.0], np.cumsum(np.diff(time) / np.broadcast_to(constant, time.shape)[1:])])
        last = np.flatnonzero(np.diff(np.floor(PULLS * passed)) > 0.0).astype(np.int64) + 1
        first = np.concatenate([[0], last])[:-1]
        seen = np.maximum(first + 1, last - (last - first) // 2).astype(np.int64)
        # after a gap what was before it tells nothing
        apart = np.diff(time)[last - 1] > 2.0 * np.median(np.diff(time))
        seen[apart] = last[apart]
        kept = np.exp(passed[first] - passed[last])
        if inertial:
            return Pull(last, seen, 1.0 - kept**2, (1.0 - kept) ** 2 / (time[last] - time[first]))
        return Pull(last, seen, 1.0 - kept, np.zeros(last.size))

    def within(self, first: int, end: int) -> tuple[NDArray[np.int64], NDArray[np.int64], Signal, Signal]:
        """The pulls after the samples from `first` on and before `end`, counted from `first`."""
        own = (self.last > first) & (self.last < end)
        return self.last[own] - first, np.maximum(self.seen[own] - first, 1), self.angle[own], self.rate[own]


def follow(
    model: Model,
    inputs: Inputs,
    time: Signal,
    measured: Signal,
    start: Signal,
    pull: Pull,
    after: Model | None = None,
    when: float = math.inf,
) -> Signal:
    """Measured quantity by `model` at each `time` [s], shape (samples,), the state pulled towards `measured`.

    A sample is what the model says before the pull that it is part of. `start` is angle [rad], velocity [rad/s],
    acceleration [rad/s^2] and way of coming, as `simulate` begins.
    `after` takes over the running state `when` [s] it is time. Not a number from where the model cannot be simulated.
    """
    record, state, output = model.record()[0], blank_state()[0], np.empty(time.size)
    driven_by = channels(inputs)
    place(record, state, *start)
    begin(record, state, *driven_by, time[0])
    split = time.size if after is None else int(np.searchsorted(time, when))
    for part, first, end in ((model, 0, min(split + 1, time.size)), (after, split, time.size)):
        if part is not None and end > first:
            own = pull.within(first, end)
            pulled(
                part.record()[0],
                state,
                *driven_by,
                time[first:end],
                measured[first:end],
                *own,
                angle_per_unit(part),
                output[first:end],
            )
    return output


@kernel
def pulled(p, s, input_times, command, supply, enabled, times, measured, last, seen, angle, rate, per_unit, output):
    """`run`, with a pull after each of the samples `last`."""
    first, before = 0, np.nan
    for index in range(last.size):
        end = last[index]
        run(p, s, input_times, command, supply, enabled, times[first : end + 1], output[first : end + 1])
        if first > 0:
            output[first] = before
        if not math.isfinite(s.angle):
            output[first:] = np.nan
            return
        error = 0.0
        for sample in range(seen[index], end + 1):
            error += measured[sample] - output[sample]
        error *= per_unit / (end + 1 - seen[index])
        if p.sensor == SPEED:
            turn(s, angle[index] * error)
        else:
            displace(p, s, angle[index] * error)
            turn(s, rate[index] * error)
        first, before = end, output[end]
    run(p, s, input_times, command, supply, enabled, times[first:], output[first:])
    if first > 0:
        output[first] = before
