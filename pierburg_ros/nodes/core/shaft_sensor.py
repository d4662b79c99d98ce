"""Angle and velocity of the shaft as a reader of the Hall sensor knows them."""

from __future__ import annotations

from pierburg_ros.actuators import Actuator
from pierburg_ros.plant import Model
from pierburg_ros.plant.torques.sensor import decode


class ShaftSensor:
    """Decodes Hall voltages with the actuator's nominal sensor; velocity is the filtered derivative."""

    def __init__(self, actuator: Actuator, time_constant: float) -> None:
        self._record = Model.nominal(actuator).record()[0]
        self.time_constant = time_constant
        self.reset()

    def reset(self) -> None:
        """Forget the past: the next sample has velocity 0."""
        self.angle: float | None = None
        self.velocity = 0.0

    def take(self, hall_voltage: float, elapsed: float) -> tuple[float, float]:
        """Angle [rad] and velocity [rad/s] from a sample [V] taken `elapsed` [s] after the previous one."""
        angle = decode(self._record, hall_voltage, False)
        if self.angle is not None and elapsed > 0.0:
            difference = (angle - self.angle) / elapsed
            self.velocity += (difference - self.velocity) * elapsed / (self.time_constant + elapsed)
        self.angle = angle
        return angle, self.velocity
