"""An input that is stamped by another clock: it is stamped after the motion that it causes, or drifts away from it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.disturbance.moments import exact, squared_error
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

EARLY = 2.5
"""Samples by which an input must be stamped late. Derived: one that is recorded one sample late, as one sample may be,
and the rounding of the lag."""
DRIFTS = 10.0
"""Samples by which the lag must drift from end to end. Chosen: 20 ms at 500 Hz; less is a small delay at either end."""
FARTHEST = 2.0
"""Largest offset of an input, late or early, that is searched at the beginning of a recording, in the actuator's own
time. Chosen: 0.19 s for the valve; the audit finds larger ones."""
GRID = 0.2
"""Spacing of the offsets that are tried first, in the actuator's own time. Work: 21 simulations of the first part; all
five clocks that were off were found from there."""
HALVINGS = 4
"""How often a recording is halved to give its first part. Derived: a clock that is 0.3 % off moves by 11 ms in a
sixteenth of a minute, which the steps of the grid cover. The offset found in a part has doubled at the end of the next
one."""
ALONE = 2.0
"""Largest mean squared error of a sample [noise^2], over any part, with which the clock may be the only error. Chosen:
the right times leave 1.0; missing physics leaves more, from the first part onwards in which the shaft moves; not
varied."""
LEFT = 0.5
"""Largest share of the cost that the best offsets may leave. Chosen: the true ones left 0.05 to 0.16 beside the right
physics (n = 5); other errors left 0.93 and more (n = 4)."""


@dataclass(frozen=True)
class OtherClock:
    """The input of a recording from `first` to `last` [s] is stamped late: by `at_first` [s], by `at_last` at the
    end."""

    first: float
    last: float
    at_first: float
    at_last: float

    def true(self, time: Signal) -> Signal:
        """The times [s] at which inputs acted that are stamped `time` [s], shape (changes,)."""
        share = (time - self.first) / (self.last - self.first)
        return np.asarray(time - self.at_first - share * (self.at_last - self.at_first))

    def applied(self, run: Run) -> Run:
        """`run` with its inputs at the times when they acted."""
        return replace(run, inputs=replace(run.inputs, time=self.true(run.inputs.time)))

    def known(self, recording: Recording) -> Recording:
        """`recording` as if its input, and the other logged channels of the drive, had been stamped when they acted."""
        return replace(
            recording,
            command=self._moved(recording.command),
            supply_voltage=recording.supply_voltage and self._moved(recording.supply_voltage),
            enabled=recording.enabled and self._moved(recording.enabled),
        )

    def _moved(self, channel: Channel) -> Channel:
        return Channel(self.true(channel.time), channel.values)

    def wrong(self, interval: float) -> bool:
        """Whether no delay does that: motion precedes its cause, or drifts away from it, by several times the
        `interval` [s]."""
        late = max(self.at_first, self.at_last) > EARLY * interval
        return late or abs(self.at_last - self.at_first) > DRIFTS * interval

    def remark(self, driven: str) -> str:
        """The remark for the report."""
        return (
            f"the {driven} seems to be stamped by another clock, {1e3 * self.at_first:.3g} ms late at the beginning and"
            f" {1e3 * self.at_last:.3g} ms at the end; it is moved to where it acted. Stamp all signals by one clock:"
            " choose it with --time stamp, publish or log."
        )


def other_clock(data: Data, model: Model, alone: bool = False) -> OtherClock | None:
    """By how much the input is stamped late, if that is why `model` fails; None if it is not, or where it is a delay.

    `alone`: return None as soon as a part shows another error as well.

    The search finds the best two offsets, at the beginning and at the end of the first part of a recording. It then
    does so for the first two parts, four, and so on: a clock that drifts is far off at the end, and hardly at the
    beginning. Large errors count by their logarithm.
    """
    own, time = data.scales.time, np.concatenate([run.time for run in data.runs])
    first, duration = float(time[0]), float(time[-1] - time[0])
    parts = duration / 2.0 ** np.arange(HALVINGS, -1, -1)
    costs = [partial(_cost, _until(data, first + part), model, first, first + part) for part in parts]
    grid = own * np.arange(-FARTHEST, FARTHEST + 0.5 * GRID, GRID)
    begin, rate = min(grid, key=lambda late: costs[0](np.full(2, late))), 0.0
    for part, cost in zip(parts, costs, strict=True):
        late, left = exact(cost, np.array([begin, begin + rate * part]), 0.5 * GRID * own, own)
        if alone and left > ALONE * np.count_nonzero(time < first + part):
            return None
        begin, rate = late[0], (late[1] - late[0]) / part
    clock = OtherClock(first, first + duration, *map(float, late))
    if left > LEFT * costs[-1](np.zeros(2)) or not clock.wrong(float(np.median(np.diff(time)))):
        return None
    return clock


def _until(data: Data, moment: float) -> Data:
    """The data before a `moment` [s]."""
    begun = (run for run in data.runs if run.time[0] < moment)
    return replace(data, runs=tuple(run.cut(moment - run.time[0]) for run in begun))


def _cost(data: Data, model: Model, first: float, last: float, late: Signal) -> float:
    """The squared error with the input stamped `late` by so much [s] at `first` and at `last`, shape (2,)."""
    # a clock neither stands still nor runs backwards
    if late[1] - late[0] >= last - first:
        return np.inf
    return float(np.sum(squared_error(data, model, OtherClock(first, last, *late).applied)))
