"""The error of a simulation that wrong stamps cause."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.estimation.memory import remaining, top_speed
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of
from pierburg_ros.recording.stamps import ACROSS, rates, stamp_error


def stamp_noise(recording: Recording, model: Model) -> float:
    """Standard deviation [measured unit] that wrong stamps add to the error of a simulation by `model`.

    A sample is wrong by the movement of the shaft during the error of its stamp. After a change of the duty, the shaft
    is wrong by the movement that the change causes in that time, until `model` forgets it. The stamps of the duty are
    taken to be as wrong as those of the samples.
    """
    time, measured = recording.time, recording.measured
    noise = noise_of(time, measured)
    off = stamp_error(time, measured, noise)
    if off == 0.0:
        return 0.0
    own = 2.0 * (noise / (ACROSS * float(np.median(np.diff(time))))) ** 2
    seen = off * math.sqrt(max(float(np.mean(np.square(rates(time, measured)))) - own, 0.0))
    if recording.input != "duty":
        return seen
    inside = (recording.command.time >= time[0]) & (recording.command.time <= time[-1])
    moved = top_speed(model) * off * np.abs(np.diff(recording.command.values[inside])) / abs(angle_per_unit(model))
    return math.hypot(seen, remaining(moved, model, recording.duration))
