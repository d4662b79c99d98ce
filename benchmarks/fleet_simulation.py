"""A simulated fleet of valves over a year: who ages how, and its recordings, made by the second formulation.

Every unit is recorded at the same routine: 12 s at 250 Hz, pushes below zero duty at the closed stop, stairs and steps,
one of them onto the open stop: only there the upper end of the sensor is told apart from resistance and stiffness. The
winding follows the temperature, which follows the season and the day; the supply lies between 12.6 and 14.4 V. Both are
recorded. New units are alike: with a spread between them every recording differs from the description in several
parameters, and its diagnosis takes a minute of processor time in place of seconds.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from importlib import resources
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.proof.formulation import NOMINAL, simulate_textbook
from pierburg_ros.recording.write import write_recording

FLOAT64 = "std_msgs/msg/Float64"
RATE, LENGTH = 250.0, 12.0  # Hz, s
COPPER = 0.0039  # 1/K
BEGIN = datetime(2025, 1, 6, tzinfo=timezone.utc)
YEAR = 365.0  # days
REPAIR = 0.55  # of the year
Law = Callable[[float], dict[str, float]]  # share of the year lived to factors of base parameters and effects' values
AGEING: dict[str, tuple[str, Law]] = {
    "gear wear": ("backlash.gap", lambda t: {"backlash.gap": 0.06 * t, "backlash.motor_friction_share": 0.3}),
    "fading magnets": ("torque_constant", lambda t: {"torque_constant": 1.0 - 0.08 * t}),
    "spring fatigue": ("spring_stiffness", lambda t: {"spring_stiffness": 1.0 - 0.10 * t}),
    "growing friction": ("coulomb_friction", lambda t: {"coulomb_friction": 1.0 + 0.25 * t}),
    "sensor drift": ("hall_voltage_open", lambda t: {"hall_voltage_open": 1.0 - 0.015 * t}),
}
"""What ages, the quantity that shows it, and how: factors of base parameters, values of effects."""


@dataclass(frozen=True)
class Unit:
    """A unit: its name, how it ages (`steady` or one of `AGEING`) and whether it is repaired in between."""

    name: str
    kind: str
    repaired: bool

    def values(self, lived: float) -> dict[str, float]:
        """Values of the plant after a share of the year, at 20 degC."""
        since = lived - REPAIR if self.repaired and lived >= REPAIR else lived
        changes = AGEING[self.kind][1](since) if self.kind in AGEING else {}
        factors = {name: NOMINAL[name] * value for name, value in changes.items() if "." not in name}
        return {**NOMINAL, **factors, **{name: value for name, value in changes.items() if "." in name}}


def units(count: int) -> list[Unit]:
    """A quarter of the fleet ages, each in one way, a twentieth more is repaired in between, the rest is steady."""
    ways, ageing, repaired = list(AGEING), max(count // 4, len(AGEING)), max(count // 20, 1)
    kinds = [ways[n % len(ways)] for n in range(ageing)] + ["growing friction", "fading magnets"][:repaired]
    found = []
    for number in range(count):
        kind = kinds[number] if number < len(kinds) else "steady"
        found.append(Unit(f"valve-{number:03d}", kind, ageing <= number < ageing + repaired))
    return found


def routine() -> tuple[Signal, Signal]:
    """Times [s] and duty [1] of the recording that every unit makes."""
    time = np.arange(round(RATE * LENGTH)) / RATE
    levels = [0.0, -0.12, 0.20, -0.10, 0.22, 0.10, 0.18, 0.22, 0.26, 0.30, 0.24, 0.18, 0.10, 0.0]
    levels += [-0.12, 0.25, 0.05, 0.60, 0.15, 0.28, 0.02, 0.24, 0.30, -0.08, 0.23, 0.0]
    return time, np.array(levels)[np.minimum((time / LENGTH * len(levels)).astype(int), len(levels) - 1)]


def record(unit: Unit, lived: float, folder: Path, random: np.random.Generator) -> None:
    """Write one recording of a unit, with the time of its first sample as the bag's own."""
    moment = BEGIN + timedelta(days=YEAR * lived)
    season = 20.0 - 9.0 * np.cos(2.0 * np.pi * lived)
    temperature, supply = season + 4.0 * random.standard_normal(), random.uniform(12.6, 14.4)
    values = unit.values(lived)
    values["armature_resistance"] *= 1.0 + COPPER * (temperature - 20.0)
    time, duty = routine()
    ideal = simulate_textbook(values, time, duty, supply_voltage=np.full(time.size, supply))
    step = 5.0 / 4096.0
    measured = step * np.round((ideal + 0.002 * random.standard_normal(time.size)) / step)
    origin, slow = moment.timestamp(), time[::50]
    write_recording(
        folder / f"{moment:%Y%m%dT%H%M%S}.mcap",
        {
            "/supply_voltage": (FLOAT64, origin + slow, np.full(slow.size, supply)),
            "/temperature": (FLOAT64, origin + slow, temperature + 0.3 * random.standard_normal(slow.size)),
            "/hall_voltage": (FLOAT64, origin + time, measured),
            "/duty": (FLOAT64, origin + time, duty),
        },
    )


def simulate(folder: Path, count: int, recordings: int, seed: int) -> None:
    """The recordings of the fleet, a folder for each unit, and what is true of it; what is there stays."""
    truth = {}
    for number, unit in enumerate(units(count)):
        own = folder / "recordings" / unit.name
        own.mkdir(parents=True, exist_ok=True)
        random = np.random.default_rng([seed, number])
        lives = (np.arange(recordings) + random.uniform(0.1, 0.9, recordings)) / recordings
        truth[unit.name] = {"kind": unit.kind, "repaired": unit.repaired, "lived": lives.tolist()}
        if len(list(own.iterdir())) == recordings:
            continue
        for place, lived in enumerate(lives):
            record(unit, float(lived), own, np.random.default_rng([seed, number, place]))
    (folder / "truth.json").write_text(json.dumps(truth, indent=1))
    (folder / "valve.yaml").write_text(description())


def description() -> str:
    """The shipped description with the upper end of the sensor freed, so that its drift can be said."""
    text = (resources.files("pierburg_ros.actuators") / "pierburg.yaml").read_text(encoding="utf-8")
    found = [line for line in text.splitlines() if line.strip().startswith("hall_voltage_open")]
    return text.replace(found[0], found[0].replace(", free: false", "")).replace("name: pierburg", "name: fleet_valve")
