"""A fleet as diagnosed and measured, without any diagnosis."""

from datetime import datetime, timedelta, timezone

import numpy as np

from pierburg_ros.fleets.fleet import fleet_of
from pierburg_ros.fleets.recordings.units import Source
from pierburg_ros.fleets.run import Examined
from pierburg_ros.library.model import Model

BEGIN = datetime(2025, 1, 1, tzinfo=timezone.utc)
RESULT = {
    "problem": None,
    "begun": None,
    "duration": 12.0,
    "samples": 3000,
    "temperature": None,
    "supply_voltage": 13.5,
    "verdict": "consistent",
    "stopped": False,
    "summary": "All is as described.",
    "faults": [],
    "noise_floor": 0.002,
    "nominal_rmse": 0.002,
    "final_rmse": 0.002,
    "processor_time": 2.0,
    "findings": [],
}


def examined(unit, number, resistance, day, deviation=0.001, **changes):
    """A recording of a unit on a day after `BEGIN`, with its resistance [ohm]."""
    source = Source(f"/runs/{unit}/{number}.mcap", unit, BEGIN + timedelta(days=float(day)))
    measured = {"armature_resistance": {"value": float(resistance), "deviation": deviation, "determined": True}}
    return Examined(source, f"{unit}-{number}", {**RESULT, **changes}, measured)


def limited(high):
    """A finding that rules out play above `high` [rad]."""
    numbers = {"value": None, "low": None, "high": high, "confidence": None}
    return {"kind": "ruled_out", "name": "backlash.gap", "unit": "rad", "identifiable": True, **numbers}


def named(gap):
    """A finding that names play of a `gap` [rad]."""
    numbers = {"value": gap, "low": gap - 0.002, "high": gap + 0.002, "confidence": 0.99}
    return {"kind": "effect", "name": "backlash.gap", "unit": "rad", "identifiable": True, **numbers}


def fleet(units=8, recordings=10, limits=None, seed=3):
    """Units around 4.139 ohm: the first rises by 0.6 ohm a year, the second steps by 0.3; and a file that is none."""
    random, made = np.random.default_rng(seed), []
    days = np.linspace(0.0, 365.0, recordings)
    for number in range(units):
        rise = 0.6 * days / 365.0 if number == 0 else np.zeros(recordings)
        step = np.where(days > 180.0, 0.3, 0.0) if number == 1 else np.zeros(recordings)
        values = 4.139 + rise + step + 0.01 * random.standard_normal(recordings)
        name = f"valve-{number:03d}"
        made += [examined(name, k, value, day) for k, (value, day) in enumerate(zip(values, days, strict=True))]
    bad = Examined(Source("/runs/valve-002/bad.mcap", "valve-002"), "", {"problem": "bad.mcap is no recording."}, {})
    return fleet_of([*made, bad], Model.nominal("pierburg"), limits or {})
