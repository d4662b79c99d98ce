"""An input that is logged in coarse steps: values between them moved the shaft and are not known."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.likelihood import EXPLAINED, grid
from pierburg_ros.plant import Inputs
from pierburg_ros.recording import Recording

AS_MUCH = 3.0
"""Largest remainder that rounding may have caused, in multiples of what rounding does to the nominal model. Chosen:
roundings drawn at random do more or less, and those of long holds count most; not varied."""


@dataclass(frozen=True)
class Rounding:
    """The effect on the signal of the steps in which a recording's input was logged: `size` in the measured unit."""

    recording: Recording
    step: float
    size: float

    def kept_apart(self, data: Data) -> Data:
        """`data` in which this effect counts as noise, and a residual of its size is no evidence."""
        return data.kept_apart(self.size)

    def said(self, data: Data, unsettled: bool) -> Data:
        """`data` with a remark on it; `unsettled` where no explanation was found that stands out beside it."""
        name, driven = self.recording.name, self.recording.input
        moved = f"{self.size:.2g} {data.actuator.unit}"
        then = ", as much as is left: no effect can be concluded" if unsettled else ", which counts as noise"
        remark = (
            f"{name}: the {driven} is logged in steps of {self.step:.3g}. If what was applied lay between them, that"
            f" moves the signal by some {moved}{then}. Log the {driven} as it is applied."
        )
        return replace(data, remarks=(*data.remarks, remark))


def rounded(found: Found, recording: Recording) -> Rounding | None:
    """The steps in which the input was logged, if the whole remainder may come from them; otherwise None."""
    step = grid(recording.command.values)
    if step == 0.0:
        return None
    moved = []
    for run in found.data.runs:
        between = replace(run, inputs=between_steps(run.inputs, recording, step))
        moved.append(between.simulated(found.nominal) - run.simulated(found.nominal))
    does = rms(np.concatenate(moved)) / found.data.noise
    if np.hypot(1.0, does) <= EXPLAINED or found.chosen.ratio > AS_MUCH * np.hypot(1.0, does):
        return None
    return Rounding(recording, step, does * found.data.noise)


def between_steps(inputs: Inputs, recording: Recording, step: float) -> Inputs:
    """`inputs` of a recording as they may have been applied: off by up to half a step while a logged value holds."""
    values = recording.command.values
    held = np.cumsum(np.diff(values, prepend=values[0]) != 0.0)
    off = np.random.default_rng(0).uniform(-0.5, 0.5, held[-1] + 1)[held] * step
    place = np.searchsorted(recording.command.time, inputs.time, side="right") - 1
    command = inputs.command + np.where(place < 0, 0.0, off[np.maximum(place, 0)])
    return replace(inputs, command=np.clip(command, -1.0, 1.0) if recording.input == "duty" else command)
