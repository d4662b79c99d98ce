"""The plant step by step, for nodes and for loops that are not compiled."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.plant.model import Model
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state
from pierburg_ros.plant.torques.sensor import measured, quantised


class Plant:
    """One simulated actuator with a noisy sensor; `model` may be replaced while it runs and the state stays."""

    def __init__(self, model: Model, noise: float = 0.0, seed: int = 0) -> None:
        """`noise` is the standard deviation of the sensor noise, in the measured unit."""
        self.noise = noise
        self._seed = seed
        self.model = model
        self.reset()

    @property
    def model(self) -> Model:
        """The model in force."""
        return self._model

    @model.setter
    def model(self, model: Model) -> None:
        self._model = model
        self._record = model.record()

    def reset(self, angle: float = 0.0) -> None:
        """Back to time 0 at `angle` [rad], at rest and cold, with the noise from its start."""
        self._state = new_state(self._record, angle)
        self._random = np.random.default_rng(self._seed)

    def advance(
        self, command: float, duration: float, supply_voltage: float | None = None, enabled: bool = True
    ) -> None:
        """Let `command` act for `duration` [s]."""
        supply = math.nan if supply_voltage is None else supply_voltage
        advance(self._record[0], self._state[0], command, supply, enabled, duration)

    def measure(self) -> float:
        """One sample of the sensor, noise and converter included (V, rad or rad/s)."""
        value = measured(self._record[0], self._state[0]) + self.noise * self._random.standard_normal()
        return float(quantised(self._record[0], value))

    @property
    def angle(self) -> float:
        """True shaft angle [rad]."""
        return float(self._state["angle"][0])

    @property
    def velocity(self) -> float:
        """True shaft velocity [rad/s]."""
        return float(self._state["velocity"][0])

    @property
    def time(self) -> float:
        """Time since the last reset [s]."""
        return float(self._state["time"][0])
