"""A bridge that was open for a while: the motor neither drives nor brakes the shaft, while the command continues."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.disturbance.moments import exact, squared_error
from pierburg_ros.diagnosis.disturbance.window import BLOCK, LONGEST
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.loss import Span

FINE = 0.25
"""Spacing of the moments that are tried first, in blocks. Work: 60 ms for the valve, some 300 simulations of a
one-minute recording; the six open bridges were found from there."""
SOON = 4.0
"""Number of blocks of a stretch that determine when the bridge opened. Chosen: a second for the valve, ten times as
long as its spring takes to move it; not varied."""
LEFT = 0.2
"""Largest share of the cost within the stretch that the best moments may leave. Chosen: midway between two groups, as
ratios go. The true moments left 0.009 to 0.073 (n = 6 open bridges). The best moments left 0.54 and more in other
cases: a hand on the lever (n = 8), and a load that came and went, a slip or a change (n = 11)."""


@dataclass(frozen=True)
class OpenBridge:
    """The bridge was open from `start` to `end` [s]."""

    start: float
    end: float

    def applied(self, run: Run) -> Run:
        """`run` with the bridge open during that time."""
        time = np.unique(np.concatenate([run.inputs.time, [self.start, self.end]]))
        enabled = (time < self.start) | (time >= self.end)
        return replace(run, inputs=replace(run.inputs.at(time), enabled=enabled))

    def known(self, recording: Recording) -> Recording:
        """`recording` as if the state of the bridge had been logged."""
        time = np.array([min(float(recording.time[0]), self.start) - 1.0, self.start, self.end])
        return replace(recording, enabled=Channel(time, np.array([1.0, 0.0, 1.0])))

    @property
    def remark(self) -> str:
        """The remark for the report."""
        return (
            f"from {self.start:.4g} to {self.end:.4g} s the bridge seems to have been open: the shaft moves as without"
            " a current. That stretch is simulated so. Log the state of the bridge as enabled."
        )


def opened(data: Data, model: Model, span: Span) -> OpenBridge | None:
    """The time during which the bridge was open, if that is why `model` fails in a `span` [s] of a recording.

    None if it is not, or where the state of the bridge was logged. The bridge is open for at least a block: a shorter
    time is a nudge, which can explain any slip that came at another moment. The search first finds when the bridge
    opens, from the errors soon after. It then finds when the bridge closes, from all errors of the stretch. Last it
    refines both. Large errors count by their logarithm.
    """
    if any(run.inputs.enabled is not None for run in data.runs):
        return None
    block, step = BLOCK * data.scales.time, FINE * BLOCK * data.scales.time
    first, last = float(data.runs[0].time[0]), float(data.runs[-1].time[-1])
    longest = LONGEST * (last - first)
    lowest, highest = max(span[0] - longest, first), min(span[1] + longest, last)
    time = np.concatenate([run.time for run in data.runs])

    def cost(start: float, end: float, until: float = highest) -> float:
        error = squared_error(data, model, OpenBridge(start, end).applied)
        return float(np.sum(error[(time >= lowest) & (time <= until)]))

    def possible(moments: Signal) -> float:
        start, end = map(float, moments)
        return cost(start, end) if first <= start <= end - block else np.inf

    # a shaft at rest shows the open bridge late
    about = span[0] + SOON * block
    starts = [*np.arange(span[0] - block, lowest, -block), *np.arange(span[0] - block, about, step)]
    start = min(starts, key=lambda start: cost(start, last, about))
    end = min(np.arange(start + block, start + longest, step), key=lambda end: cost(start, end))
    untouched = cost(lowest, lowest)
    (start, end), left = exact(possible, np.array([start, end]), step, data.scales.time)
    return OpenBridge(float(start), float(end)) if left <= LEFT * untouched else None
