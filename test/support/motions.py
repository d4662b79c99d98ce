"""A shaft whose motion is known: drawn, not simulated."""

import numpy as np
from support.recordings import PIERBURG

from pierburg_ros.diagnosis.motion import Motion, motion_of
from pierburg_ros.inference.data import Run, start_of
from pierburg_ros.plant import Inputs

NOISE = 0.002
CORNERS = ((0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (5.0, 1.0), (6.0, 0.4), (7.0, 0.4), (7.5, 0.0), (10.0, 0.0))
"""Times [s] and angles [rad] of the corners of the course: opens at 2 s, closes at 5 s and again at 7 s."""


def hall(angle: np.ndarray) -> np.ndarray:
    """Hall voltage [V] of the nominal sensor."""
    return 0.42 + 4.1 * angle / (np.pi / 2)


def run_along(corners=CORNERS, duty=None, rate: float = 500.0, seed: int = 0) -> Run:
    """A run along straight lines between `corners` with 2 mV of noise; `duty` defaults to zero."""
    times, angles = np.transpose(corners)
    time = np.arange(0.0, times[-1], 1.0 / rate)
    noise = NOISE * np.random.default_rng(seed).standard_normal(time.size)
    inputs = Inputs(time, np.zeros(time.size) if duty is None else duty(time))
    measured = hall(np.interp(time, times, angles)) + noise
    return Run(
        name="drawn.mcap",
        number=0,
        inputs=inputs,
        time=time,
        measured=measured,
        shown=start_of(time, measured),
        settled=np.ones(time.size, dtype=bool),
        block=np.zeros(time.size, dtype=np.int64),
        counts=np.ones(time.size, dtype=bool),
        quantity="hall_voltage",
    )


def drawn(**options) -> Motion:
    """The motion of `run_along`."""
    return motion_of(run_along(**options), PIERBURG, NOISE)
