"""A simulated servo in its own closed loop, whose duty follows from setpoint and angle by a rule."""

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Model
from pierburg_ros.plant.plant import Plant
from pierburg_ros.recording import Channel, Recording

SERVO = Model.nominal(read_actuator("xl330"))
LACKING = SERVO.with_values({"load_dependent_friction.coefficient": 0.2, "supply_sag.source_resistance": 1.0})
"""What a servo has and its description lacks, so that the motion alone does not tell when its duty acted."""
STEP = 0.005
TIME = np.arange(0.0, 10.0, STEP)
GAIN = 1.1


def in_loop(
    slow: int = 0,
    seed: int = 0,
    gain: float = GAIN,
    weight: float = 1.0,
    size: float = 0.5,
    beyond: float = 0.0,
    integral: float = 0.0,
    derivative: float = 0.0,
) -> Recording:
    """A servo that follows smooth setpoints by a duty that is computed from what was `slow` samples before.

    A controller that makes up for friction sets its duty `beyond` what is proportional to the error. One may have an
    `integral` [1/s] or a `derivative` [s] of the measured angle besides, each over its gain.
    """
    phases = np.random.default_rng(seed).uniform(0.0, 6.0, 3)
    wanted = sum(size * np.sin(rate * TIME + phase) for rate, phase in zip((1.1, 2.7, 4.9), phases, strict=True))
    plant = Plant(LACKING, noise=0.0007, seed=seed)
    measured, duty, area = np.empty(TIME.size), np.zeros(TIME.size), 0.0
    for sample in range(TIME.size):
        measured[sample] = plant.measure()
        past = sample - slow
        if past >= 0:
            error, rate = weight * wanted[past] - measured[past], (measured[past] - measured[max(past - 1, 0)]) / STEP
            area += error * STEP
            asked = gain * (error + integral * area - derivative * rate)
            duty[sample] = np.clip(asked + np.copysign(beyond, asked), -1.0, 1.0)
        plant.advance(duty[sample], STEP)
    return Recording("loop", "position", TIME, measured, Channel(TIME, duty), setpoints=Channel(TIME, wanted))
