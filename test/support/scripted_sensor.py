"""A process that plays an actuator with a sensor that breaks on cue, and measures how its controller answers.

python scripted_sensor.py FAULT REPEATS prints one JSON line: seconds from each fault to duty 0, or swings at spikes.
The shaft follows the sliding equation of the paper, so that nothing of the simulator is needed here.
"""

from __future__ import annotations

import json
import math
import random
import sys
import time

import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import Float64

PERIOD = 0.002
HEALTHY = 0.6  # s between two faults
PATIENCE = 20.0  # s until an answer is given up
SETPOINTS = (0.8, 0.5)  # rad
SPIKE_EVERY = 100  # samples


def turned(angle: float, duty: float, dt: float) -> float:
    """Angle [rad] after `dt` [s] of sliding motion with the numbers of Table I, between the stops."""
    drive = 2.677 * duty - 0.29 - 0.1419 * angle
    friction = math.copysign(0.2007, drive)
    moved = dt * (drive - friction) / 0.1627 if abs(drive) > 0.2007 else 0.0
    return min(max(angle + moved, 0.0), math.pi / 2)


class Bench:
    """Publishes Hall samples at 500 Hz and keeps what comes back."""

    def __init__(self, fault: str) -> None:
        self.node = rclpy.create_node("plant")
        self.fault = fault
        self.hall = self.node.create_publisher(Float64, "hall_voltage", QoSProfile(depth=10))
        self.setpoint = self.node.create_publisher(Float64, "setpoints", QoSProfile(depth=10))
        self.node.create_subscription(Float64, "duty", self._take, QoSProfile(depth=100))
        self.random = random.Random(1)
        self.angle, self.duty, self.samples = 0.0, 0.0, 0
        self.duties: list[tuple[float, float]] = []
        self.frozen = 0.42
        self.next = time.monotonic()

    def _take(self, message: Float64) -> None:
        self.duty = message.data
        self.duties.append((time.monotonic(), message.data))

    def voltage(self, broken: bool) -> float | None:
        """One Hall sample [V]; None is silence."""
        good = 0.42 + 4.1 * self.angle / (math.pi / 2) + self.random.gauss(0.0, 0.003)
        if not broken:
            self.frozen = good
            return good
        spike = 5.0 if self.samples % SPIKE_EVERY == 0 else good
        faults = {"zero": 0.0, "five": 5.0, "nan": math.nan, "frozen": self.frozen, "silence": None, "spikes": spike}
        return faults[self.fault]

    def tick(self, broken: bool = False) -> None:
        """One sample on the grid of the rate, and what has come meanwhile."""
        self.next = max(self.next + PERIOD, time.monotonic() - 0.05)
        rclpy.spin_once(self.node, timeout_sec=max(self.next - time.monotonic(), 0.0))
        while time.monotonic() < self.next:
            rclpy.spin_once(self.node, timeout_sec=max(self.next - time.monotonic(), 0.0))
        self.angle = turned(self.angle, self.duty, PERIOD)
        self.samples += 1
        voltage = self.voltage(broken)
        if voltage is not None:
            self.hall.publish(Float64(data=voltage))

    def healthy(self, seconds: float) -> bool:
        """A healthy sensor until the controller steers and so long has passed; False if it never does."""
        begun = time.monotonic()
        while time.monotonic() - begun < PATIENCE + seconds:
            self.tick()
            if time.monotonic() - begun > seconds and self.duty > 0.05:
                return True
        return False

    def broken(self) -> float | None:
        """Seconds until a duty 0 that stays for 0.3 s after the sensor breaks; None: never.

        A stall of the machine is answered with duty 0 too, which ends with the stall.
        """
        begun, answered = time.monotonic(), None
        while time.monotonic() - begun < PATIENCE and (answered is None or time.monotonic() - answered < 0.3):
            count = len(self.duties)
            self.tick(broken=True)
            for at, duty in self.duties[count:]:
                answered = None if duty else answered or at
        return None if answered is None else answered - begun

    def spiked(self, spikes: int) -> list[float]:
        """For each answered spike how far the duties up to half the way to the next one are from the one before it."""
        swings = []
        for _ in range(spikes):
            while (self.samples + 1) % SPIKE_EVERY:
                self.tick(broken=True)
            before, count = self.duty, len(self.duties)
            for _ in range(SPIKE_EVERY // 2):
                self.tick(broken=True)
            if answers := self.duties[count:]:
                swings.append(max(abs(duty - before) for _, duty in answers))
        return swings


def main() -> None:
    """Break the sensor as often as told."""
    fault, repeats = sys.argv[1], int(sys.argv[2])
    rclpy.init()
    bench = Bench(fault)
    while not (bench.duties and bench.setpoint.get_subscription_count()):
        bench.tick()
    found: dict[str, object] = {"fault": fault, "seconds": [], "returned": []}
    for repeat in range(repeats):
        bench.setpoint.publish(Float64(data=SETPOINTS[repeat % 2]))
        found["returned"].append(bench.healthy(HEALTHY))
        if fault == "spikes":
            found["seconds"].append(None)
            found["swings"] = bench.spiked(11)
            continue
        if fault == "frozen":
            bench.setpoint.publish(Float64(data=1.4))
        found["seconds"].append(bench.broken())
    found["returned"].append(bench.healthy(HEALTHY))
    print(json.dumps(found))


if __name__ == "__main__":
    main()
