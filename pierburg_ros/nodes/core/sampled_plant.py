"""One tick after another: the shaft sampled, the newest duty taken. Knows no ROS."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.nodes.core.commanded_duty import CommandedDuty
from pierburg_ros.nodes.core.physics import Physics
from pierburg_ros.nodes.core.protection.winding import Winding
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor


@dataclass(frozen=True)
class Sample:
    """What a tick at `time` [ns] gives; `duty` acts from this tick until the next."""

    time: int
    hall_voltage: float
    duty: float
    angle: float
    velocity: float


class SampledPlant:
    """A simulator, its sensor and the duty it obeys, on one row of ticks."""

    def __init__(self, physics: Physics, sensor: ShaftSensor, winding: Winding | None = None) -> None:
        """`winding`: the stall protection of the device, if it has one."""
        self.winding = winding
        self.physics = physics
        self.sensor = sensor
        self.duty = CommandedDuty()
        self.ticks = 0
        self.last: int | None = None
        self._applied = 0.0

    def tick(self, time: int, timeout: float) -> Sample:
        """Advance to `time` [ns] under the duty of the previous tick, sample, and take the newest duty."""
        elapsed = 0.0 if self.last is None else (time - self.last) * 1e-9
        self.physics.advance(self._applied, elapsed)
        voltage = self.physics.measure()
        angle, velocity = self.sensor.take(voltage, elapsed)
        self._applied = self._borne(self.duty.at(time, timeout), elapsed)
        self.last = time
        self.ticks += 1
        return Sample(time, voltage, self._applied, angle, velocity)

    def reset(self) -> None:
        """Back to the closed stop, at rest and cold; time and duty go on."""
        self.physics.reset()
        self.sensor.reset()

    def _borne(self, duty: float, elapsed: float) -> float:
        """The part of a duty that the winding bears, after it was warmed by the one before."""
        if self.winding is None:
            return duty
        self.winding.warm(self.winding.current(self._applied, self.sensor.velocity), elapsed)
        return self.winding.borne(duty, self.sensor.velocity)
