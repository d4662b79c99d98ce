"""Angle and velocity of the shaft as a reader of the Hall sensor knows them."""

from __future__ import annotations

from pierburg_ros.actuators import Actuator


class ShaftSensor:
    """Decodes Hall voltages with the actuator's nominal calibration; velocity is the filtered derivative."""

    def __init__(self, actuator: Actuator, time_constant: float) -> None:
        closed = actuator.parameters["hall_voltage_closed"].nominal
        opened = actuator.parameters["hall_voltage_open"].nominal
        self._closed = closed
        self._lower = actuator.lower_stop
        self._slope = (actuator.upper_stop - actuator.lower_stop) / (opened - closed)
        self.time_constant = time_constant
        self.reset()

    def reset(self) -> None:
        """Forget the past: the next sample has velocity 0."""
        self.angle: float | None = None
        self.velocity = 0.0

    def take(self, hall_voltage: float, elapsed: float) -> tuple[float, float]:
        """Angle [rad] and velocity [rad/s] from a sample [V] taken `elapsed` [s] after the previous one."""
        angle = self._lower + (hall_voltage - self._closed) * self._slope
        if self.angle is not None and elapsed > 0.0:
            difference = (angle - self.angle) / elapsed
            self.velocity += (difference - self.velocity) * elapsed / (self.time_constant + elapsed)
        self.angle = angle
        return angle, self.velocity
