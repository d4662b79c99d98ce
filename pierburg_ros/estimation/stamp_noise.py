"""What stamps that are off may do to the error of a simulation."""

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
    """Standard deviation that stamps which are off bring into the error of a simulation by `model`, measured unit.

    A sample is off by how far the shaft moves meanwhile. So is the shaft, after a change of the duty, by how far that
    makes it move, until `model` forgets it: stamps of the duty are taken to be off as those of samples are.
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
