"""Recordings of a simulated actuator, as a bench with a noisy sensor would make them."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.recording import Channel, Recording


def synthetic_recording(
    model: Model, time: Signal, duty: Signal, noise: float = 0.003, seed: int = 0, name: str = "simulated"
) -> Recording:
    """The recording that a bench would make of `model` from rest at angle 0.

    `duty` holds from each `time` [s] to the next; `noise` is the sensor's standard deviation [measured unit].
    """
    keep = np.concatenate([[True], np.diff(duty) != 0.0])
    changes = Channel(time[keep], duty[keep])
    clean = simulate(model, Inputs(changes.time, changes.values), time)
    refuse_unsimulated(model, clean, time)
    measured = clean + noise * np.random.default_rng(seed).standard_normal(time.size)
    actuator = model.actuator
    return Recording(
        name, actuator.quantity, time - time[0], measured, changes, time_source="publish", input=actuator.input
    )
