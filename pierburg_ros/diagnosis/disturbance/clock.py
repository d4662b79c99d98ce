"""An input that is stamped by another clock: it comes after the motion that it causes, or runs away from it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.timing import DRIFTS, EARLY
from pierburg_ros.diagnosis.disturbance.moments import exact, squared_error
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

FARTHEST = 2.0
"""Latest and earliest that an input is looked for at either end of a recording, in the actuator's own time. Chosen:
0.19 s for the valve, a clock that is 0.3 % off over a minute; farther ones are found by the audit."""
GRID = 0.2
"""Distance of the times that are tried first, in the actuator's own time. Work: 441 simulations; all five clocks that
were off were found from there."""
LEFT = 0.5
"""Share of the cost that the best times may leave. Chosen: the true ones left 0.05 to 0.16 beside the right physics
(n = 5); what is wrong elsewhere 0.93 and more (n = 4)."""


@dataclass(frozen=True)
class OtherClock:
    """The input of a recording from `first` to `last` [s] is stamped late: by `at_first` [s], `at_last` in the end."""

    first: float
    last: float
    at_first: float
    at_last: float

    def true(self, time: Signal) -> Signal:
        """When an input acted that is stamped `time` [s], shape (changes,)."""
        share = (time - self.first) / (self.last - self.first)
        return np.asarray(time - self.at_first - share * (self.at_last - self.at_first))

    def applied(self, run: Run) -> Run:
        """`run` with its inputs when they acted."""
        return replace(run, inputs=replace(run.inputs, time=self.true(run.inputs.time)))

    def known(self, recording: Recording) -> Recording:
        """`recording` as if its input had been stamped when it acted."""
        return replace(recording, command=Channel(self.true(recording.command.time), recording.command.values))

    def wrong(self, interval: float) -> bool:
        """Whether no delay does that: motion comes before its cause, or runs apart from it, by some `interval` [s]."""
        late = max(self.at_first, self.at_last) > EARLY * interval
        return late or abs(self.at_last - self.at_first) > DRIFTS * interval

    def remark(self, driven: str) -> str:
        """What is to be said of it."""
        return (
            f"the {driven} seems to be stamped by another clock, {1e3 * self.at_first:.3g} ms late at the beginning and"
            f" {1e3 * self.at_last:.3g} ms at the end; it is moved to where it acted. Stamp all signals by one clock:"
            " choose it with --time stamp, publish or log."
        )


def other_clock(data: Data, model: Model) -> OtherClock | None:
    """By how much the input is stamped late, if that is why `model` fails; None if not, or where it is a delay.

    The best two times, at the beginning and at the end of a recording, on a grid and then exactly. Large errors count
    no more.
    """
    own, time = data.scales.time, np.concatenate([run.time for run in data.runs])
    first, last = float(time[0]), float(time[-1])

    def cost(late: Signal) -> float:
        return float(np.sum(squared_error(data, model, OtherClock(first, last, *late).applied)))

    grid = own * np.arange(-FARTHEST, FARTHEST + 0.5 * GRID, GRID)
    best = min((np.array([begin, end]) for begin in grid for end in grid), key=cost)
    late, left = exact(cost, best, 0.5 * GRID * own, own)
    clock = OtherClock(first, last, *map(float, late))
    if left > LEFT * cost(np.zeros(2)) or not clock.wrong(float(np.median(np.diff(time)))):
        return None
    return clock
