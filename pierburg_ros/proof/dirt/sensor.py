"""What spoils the measured signal alone: the duty, and what the valve does, are as ever."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.proof.dirt.log import Log, Random
from pierburg_ros.proof.dirt.wander import wander

HUM = 0.010  # V, amplitude
LONGEST_SPIKE = 2.0  # V
SHORTEST_SPIKE = 0.05  # V
SENSOR_DRIFT = 0.05  # V, from end to end
CONVERTER = 5.0  # V, its range


def spikes(log: Log, random: Random) -> Log:
    """One sample in a hundred lies anywhere within 2 V of where it should."""
    size = log.hall.values.size
    height = random.uniform(SHORTEST_SPIKE, LONGEST_SPIKE, size) * random.choice([-1.0, 1.0], size)
    return _measured(log, log.hall.values + np.where(random.random(size) < 0.01, height, 0.0))


def hum(log: Log, random: Random) -> Log:
    """The mains, 10 mV at 50 or 60 Hz, a little off as mains are."""
    frequency = float(random.choice([50.0, 60.0])) + random.uniform(-0.05, 0.05)
    phase = random.uniform(0.0, 2.0 * np.pi)
    return _measured(log, log.hall.values + HUM * np.sin(2.0 * np.pi * frequency * log.hall.time + phase))


def drifting(log: Log, random: Random) -> Log:
    """The zero of the sensor wanders by some 50 mV."""
    return _measured(log, log.hall.values + SENSOR_DRIFT * wander(log.hall.time, random))


def clipping(log: Log, random: Random) -> Log:
    """The converter ends below what the sensor gives: at 80 to 95 % of the highest voltage."""
    low, high = np.min(log.hall.values), np.max(log.hall.values)
    return _measured(log, np.minimum(log.hall.values, low + random.uniform(0.8, 0.95) * (high - low)))


def _measured(log: Log, values: Signal) -> Log:
    return replace(log, hall=replace(log.hall, values=np.clip(values, 0.0, CONVERTER)))
