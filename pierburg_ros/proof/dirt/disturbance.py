"""What acts on the valve and is not logged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.proof.dirt.log import Random
from pierburg_ros.proof.dirt.wander import wander

LOWEST_SUPPLY, HIGHEST_SUPPLY = 12.0, 14.5  # V, what a supply in a car does
DISTURBED_TIME = 5.0  # s
FORCE = (0.25, 0.6)  # N.m, a hand on the lever: more than friction, less than what stops the motor


@dataclass(frozen=True)
class Disturbance:
    """Supply voltage [V], torque of a hand [N.m] and state of the bridge, shape (samples,), None where as ever."""

    supply: Signal | None = None
    torque: Signal | None = None
    enabled: Flags | None = None


def supply(time: Signal, random: Random) -> Disturbance:
    """A supply that wanders over all it may."""
    middle = 0.5 * (LOWEST_SUPPLY + HIGHEST_SUPPLY)
    return Disturbance(supply=middle + (HIGHEST_SUPPLY - LOWEST_SUPPLY) * wander(time, random))


def hand(time: Signal, random: Random) -> Disturbance:
    """A hand that takes the lever for five seconds, pulls to and fro, and trembles."""
    since = time - _start(time, random)
    size = random.uniform(*FORCE)
    pulling = np.sin(2.0 * np.pi * random.uniform(0.3, 1.0) * since + random.uniform(0.0, 6.0))
    pulling += 0.3 * random.uniform(-1.0, 1.0) + 0.15 * np.sin(2.0 * np.pi * random.uniform(4.0, 9.0) * since)
    grip = np.clip(np.minimum(since, DISTURBED_TIME - since) / 0.3, 0.0, 1.0)
    return Disturbance(torque=size * pulling * grip)


def open_bridge(time: Signal, random: Random) -> Disturbance:
    """Five seconds in which the bridge is open while the duty goes on."""
    since = time - _start(time, random)
    return Disturbance(enabled=(since < 0.0) | (since >= DISTURBED_TIME))


def _start(time: Signal, random: Random) -> float:
    """Somewhere within the recording, away from its ends [s]."""
    return float(random.uniform(0.15, 0.75) * (time[-1] - time[0]))
