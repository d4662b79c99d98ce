"""Runs that share their inputs, simulated in one call: a recording in fifty parts costs hardly more than the whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.run import Run, Switch
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import begun, decoded
from pierburg_ros.plant.simulate import simulate_stretches


@dataclass(frozen=True)
class Batch:
    """Successive runs with the same inputs."""

    runs: tuple[Run, ...]

    def simulated(self, model: Model, switch: Switch | None = None) -> Signal:
        """The simulation by `model` of each run, one after the other, shape (samples,): the same as run by run.

        With a `switch` another model takes over in the middle of each run.
        """
        if len(self.runs) == 1 or switch is not None:
            return np.concatenate([run.simulated(model, switch) for run in self.runs])
        first = self.runs[0]
        starts = begun(model, self._shown, first.quantity)
        output = simulate_stretches(model, first.inputs, self._time, self._first, starts)
        return output if first.decoder is None else decoded(first.decoder, output)

    @cached_property
    def _time(self) -> Signal:
        return np.concatenate([run.time for run in self.runs])

    @cached_property
    def _first(self) -> NDArray[np.int64]:
        return np.cumsum([0, *(run.time.size for run in self.runs[:-1])])

    @cached_property
    def _shown(self) -> Signal:
        return np.array([run.start.shown for run in self.runs])


def batches(runs: Sequence[Run]) -> Iterator[Batch]:
    """The runs in as few batches as possible, in their order."""
    for _, some in groupby(enumerate(runs), lambda each: _shared(*each)):
        yield Batch(tuple(run for _, run in some))


def _shared(place: int, run: Run) -> tuple[object, ...]:
    """A key that is equal for all runs of one batch; a run that must be simulated by itself has its place as key."""
    alone = run.shooting is not None or run.since is not None or run.quantity == "speed"
    return (place,) if alone else (id(run.inputs), run.number, run.quantity, id(run.decoder))
