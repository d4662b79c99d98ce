"""A simulated measurement without a controller: a duty in, noisy samples out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.effects import STEP
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.plant.torques.sensor import quantised


def simulate_measurement(
    model: Model,
    inputs: Inputs,
    sample_times: NDArray[np.float64],
    noise: float = 0.0,
    seed: int = 0,
    initial_angle: float = 0.0,
) -> NDArray[np.float64]:
    """Measured quantity (V, or rad where the angle is measured) at `sample_times` [s], shape (samples,).

    Gaussian noise of RMS `noise` in the measured unit is added before the converter, if there is one.
    """
    analog = model.with_values({STEP: 0.0})
    measured = simulate(analog, inputs, sample_times, initial_angle)
    refuse_unsimulated(model, measured, sample_times)
    measured += noise * np.random.default_rng(seed).standard_normal(measured.size)
    record = model.record()[0]
    return np.array([quantised(record, value) for value in measured])
