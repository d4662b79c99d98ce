"""How soon the monitor finds a change, and how often it warns without one: closed loops at 500 Hz, seeded.

`python benchmarks/monitor.py detect 20` and `python benchmarks/monitor.py days 5`; each prints a table for
docs/developers/measurements.md.
"""

from __future__ import annotations

import sys
import time
from collections import Counter

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop.service import Service, wandering_supply
from pierburg_ros.control import Settings
from pierburg_ros.monitoring.evidence import decoded
from pierburg_ros.monitoring.findings import Finding
from pierburg_ros.monitoring.monitor import Change, Monitor
from pierburg_ros.monitoring.movements import Samples
from pierburg_ros.plant import Model

RATE = 500.0
NOISE = 0.003  # V RMS, as in config/plant.yaml
HOLD = 6.0  # s between two moves: ten a minute
STEP = 10.0  # degrees
LOWEST, HIGHEST = 8.0, 82.0  # degrees, clear of the stops
BEFORE = 60.0  # s of nominal running before a change
AFTER = 180.0  # s in which it can be found
LOOK = 12.0  # s simulated at a time
SUPPLY = (12.0, 14.5, 600.0)  # V, V, s
DAY = 86_400  # s
CHANGES = {
    "resistance x 1.17": {"armature_resistance": 4.139 * 1.17},
    "Coulomb friction x 1.4": {"coulomb_friction": 0.2007 * 1.4},
    "spring stiffness x 1.2": {"spring_stiffness": 0.1419 * 1.2},
    "spring preload x 0.85": {"spring_preload": 0.29 * 0.85},
    "torque constant x 0.9": {"torque_constant": 0.022 * 0.9},
    "static friction x 1.4": {
        "static_friction.breakaway_torque": 0.2007 * 1.4,
        "static_friction.stribeck_velocity": 0.1,
    },
}


class Bench:
    """A valve in a closed loop that makes a move of ten degrees every six seconds, watched."""

    def __init__(self, seed: int, duration: int) -> None:
        """Lasts `duration` [s] at most."""
        self.nominal = Model.nominal(read_actuator("pierburg"))
        self.service = Service(self.nominal, Settings(), RATE, NOISE, seed)
        self.monitor = Monitor(self.nominal)
        self.busy = 0.0
        self._random = np.random.default_rng([seed, 1])
        self._supply = wandering_supply(duration + 1, *SUPPLY, self._random)
        self._ran = 0.0
        self._angle = 45.0

    def run(self, duration: float) -> list[Change]:
        """Changes on the way through `duration` [s]."""
        setpoint = np.repeat(self._moves(round(duration / HOLD)), round(HOLD * RATE))
        supply = np.interp(self._ran + np.arange(setpoint.size) / RATE, np.arange(self._supply.size), self._supply)
        self._ran += duration
        stretch = self.service.run(setpoint, supply)
        angle = decoded(self.nominal.actuator, stretch.hall_voltage)
        whole = np.ones(setpoint.size, dtype=bool)
        began = time.process_time()
        changes = self.monitor.take(Samples(stretch.time, angle, stretch.duty, np.full(angle.size, np.nan), whole))
        self.busy += time.process_time() - began
        return changes

    def _moves(self, count: int) -> np.ndarray:
        """Angles [rad] of a walk in steps of ten degrees."""
        angles = []
        for way in self._random.choice([-1.0, 1.0], count):
            inside = LOWEST < self._angle + way * STEP < HIGHEST
            self._angle += way * STEP if inside else -way * STEP
            angles.append(np.radians(self._angle))
        return np.array(angles)


def detect(seeds: int) -> None:
    """Time to the first finding after a change, and what it says."""
    print(f"| change | found | median | 95 % | longest | said |\n|---|---|---|---|---|---|  (n = {seeds})")
    for name, values in CHANGES.items():
        delays, said = [], Counter()
        for seed in range(seeds):
            bench = Bench(seed, round(BEFORE + AFTER))
            early = bench.run(BEFORE)
            bench.service.model = bench.nominal.with_values(values)
            found = first_finding(bench)
            said["before the change"] += len(early)
            if found is not None:
                delays.append(found.end - BEFORE)
                said[words(found)] += 1
        counts = ", ".join(f"{text} ({count})" for text, count in said.items() if count)
        times = [f"{np.quantile(delays, q):.0f} s" for q in (0.5, 0.95, 1.0)] if delays else ["-"] * 3
        print(f"| {name} | {len(delays)} of {seeds} | {' | '.join(times)} | {counts} |", flush=True)


def first_finding(bench: Bench) -> Finding | None:
    """The first finding within `AFTER`."""
    for _ in range(round(AFTER / LOOK)):
        found = [change.finding for change in bench.run(LOOK) if change.begins]
        if found:
            return found[0]
    return None


def words(finding: Finding) -> str:
    """A finding in short."""
    return f"{finding.kind}: {' or '.join(sorted(finding.names))}" if finding.names else finding.kind


def days(count: int) -> None:
    """False warnings in days of ten moves a minute on a supply that wanders, unlogged, from 12 to 14.5 V."""
    print("| day (seed) | hours so far | moves | warnings | processor time of the monitor |\n|---|---|---|---|---|")
    for seed in range(1000, 1000 + count):
        bench, said = Bench(seed, DAY), []
        for hour in range(1, 25):
            said += [change.finding.text for change in bench.run(3600.0) if change.begins]
            moves, busy = bench.monitor.movements, bench.busy
            print(f"| {seed} | {hour} | {moves} | {len(said)} | {busy:.0f} s | {' '.join(said)}", flush=True)


if __name__ == "__main__":
    {"detect": detect, "days": days}[sys.argv[1]](int(sys.argv[2]))
