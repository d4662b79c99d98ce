"""A quantity that wanders slowly, as temperatures and loads of a supply do."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.proof.dirt.log import Random

SLOW_PERIODS = (12.0, 90.0)  # s


def wander(time: Signal, random: Random) -> Signal:
    """A sum of three slow sines with time [s], from -0.5 to 0.5 over the recording [1]."""
    shortest, longest = np.log(SLOW_PERIODS)
    periods = np.exp(random.uniform(shortest, longest, 3))
    phases = random.uniform(0.0, 2.0 * np.pi, 3)
    total = sum(np.sin(2.0 * np.pi * time / period + phase) for period, phase in zip(periods, phases, strict=True))
    total = np.asarray(total)
    return np.asarray((total - total.min()) / np.ptp(total) - 0.5)
