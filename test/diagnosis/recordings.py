"""Recordings for the tests of the diagnosis, made by the simulator, so that only its own logic is at stake."""

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

PIERBURG = read_actuator("pierburg")
NOMINAL = Model.nominal(PIERBURG)
NOISE = 0.003


def recording(
    changes: dict[str, float], duration: float = 24.0, seed: int = 0, duties: tuple[float, float] = (-0.05, 0.36)
) -> Recording:
    """Random steps between two duties at 500 Hz through the nominal valve with `changes`, 3 mV of noise."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 0.002)
    steps = random.uniform(*duties, int(duration / 0.6) + 1)
    duty = steps[(time / 0.6).astype(int)]
    duty[time < 0.3] = 0.0
    return recording_under(duty, time, changes, random)


def recording_under(
    duty: np.ndarray, time: np.ndarray, changes: dict[str, float], random: np.random.Generator
) -> Recording:
    """The nominal valve with `changes` under a duty, shape (samples,), 3 mV of noise."""
    hall = simulate(NOMINAL.with_values(changes), Inputs(time, duty), time)
    return Recording(
        "test.mcap",
        "hall_voltage",
        time,
        hall + NOISE * random.standard_normal(time.size),
        Channel(time, duty),
    )
