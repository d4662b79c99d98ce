"""Faults of the input, made from practice and real recordings, and what the audit says: writes docs/input_faults.md.

`python benchmarks/input_faults.py --shared ../shared` takes some minutes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pierburg_ros.audit import audit
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.read import check_bounds

PAGE = Path(__file__).parent.parent / "docs/input_faults.md"
Make = Callable[[Recording, Recording], list[Recording]]


@dataclass(frozen=True)
class Made:
    """A fault: what it is called, how it is made of a recording and another one, and which words must name it."""

    name: str
    make: Make
    signals: tuple[str, ...]
    named: str
    on: tuple[str, ...] = ("valve", "bench")


def measured(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    return lambda one, other: [replace(one, measured=change(one.measured))]


def duty(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    return lambda one, other: [replace(one, command=Channel(one.command.time, change(one.command.values)))]


def supply(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    def make(one: Recording, other: Recording) -> list[Recording]:
        given = one.supply_voltage or Channel(one.time[:1], np.array([13.5]))
        return [replace(one, supply_voltage=Channel(given.time, change(given.values)))]

    return make


def timed(factor: float) -> Make:
    def make(one: Recording, other: Recording) -> list[Recording]:
        channels = {
            name: Channel(factor * channel.time, channel.values)
            for name in ("command", "supply_voltage", "enabled", "setpoints")
            if (channel := getattr(one, name)) is not None
        }
        changed = replace(one, time=factor * one.time, temperature=None, losses=(), **channels)
        check_bounds(changed)
        return [changed]

    return make


def later(by: float) -> Make:
    return lambda one, other: [replace(one, command=Channel(one.command.time + by, one.command.values))]


def seldom(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=Channel(one.command.time[::10], one.command.values[::10]))]


def another_run(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=other.command)]


def reversed_in_time(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=Channel(one.command.time, one.command.values[::-1]))]


def setpoint(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=one.setpoints)] if one.setpoints is not None else []


def setpoint_of_travel(one: Recording, other: Recording) -> list[Recording]:
    if one.setpoints is None:
        return []
    inside = np.clip(one.setpoints.values / (np.pi / 2), -1.0, 1.0)
    return [replace(one, command=Channel(one.setpoints.time, inside))]


def swapped(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, measured=one.command.at(one.time), command=Channel(one.time, one.measured))]


FAULTS = (
    Made("duty: polarity reversed", duty(lambda d: -d), ("duty", "position"), "polarity"),
    Made("duty: percent for fractions", duty(lambda d: 100 * d), ("duty",), "percent"),
    Made("duty: counts of 10 bit for fractions", duty(lambda d: np.round(1023 * d)), ("duty",), "counts"),
    Made("duty: divided by 100 twice", duty(lambda d: d / 100), ("duty",), "hundredth"),
    Made("duty: 0.5 stands for none", duty(lambda d: 0.5 + 0.5 * d), ("duty",), "0.5"),
    Made("duty: magnitude without sign", duty(np.abs), ("duty",), "", on=("bench",)),
    Made("duty: of another run", another_run, ("duty",), "does not cause"),
    Made("duty: run backwards", reversed_in_time, ("duty",), "does not cause"),
    Made("duty: stamped 20 ms late", later(0.02), ("duty",), "late"),
    Made("duty: stamped 50 ms late", later(0.05), ("duty",), "late"),
    Made("duty: stamped 1 s late", later(1.0), ("duty",), "late"),
    Made("duty: logged at a tenth of the rate", seldom, ("duty",), ""),
    Made("duty: setpoint in its place [rad]", setpoint, ("duty",), "setpoint"),
    Made("duty: setpoint in its place, share of the travel", setpoint_of_travel, ("duty",), "setpoint", on=("valve",)),
    Made("duty: constant", duty(lambda d: np.zeros_like(d)), ("duty",), ""),
    Made("duty and sensor swapped", swapped, ("duty", "hall_voltage", "position"), ""),
    Made("sensor: polarity reversed", measured(lambda v: 4.94 - v), ("hall_voltage",), "polarity", on=("valve",)),
    Made("sensor: polarity reversed", measured(lambda v: -v), ("position", "duty"), "polarity", on=("bench",)),
    Made("sensor: negated", measured(lambda v: -v), ("hall_voltage",), "negated", on=("valve",)),
    Made("sensor: millivolts for volts", measured(lambda v: 1e3 * v), ("hall_voltage",), "millivolts", on=("valve",)),
    Made("sensor: counts, 12 bit over 5 V", measured(lambda v: np.round(v * 819)), ("hall_voltage",), "counts", on=("valve",)),
    Made("sensor: counts, 10 bit over 5 V", measured(lambda v: np.round(v * 204.6)), ("hall_voltage",), "counts", on=("valve",)),
    Made("sensor: behind a divider by 2", measured(lambda v: 0.5 * v), ("hall_voltage",), "scale", on=("valve",)),
    Made("sensor: gain of 2", measured(lambda v: 2.0 * v), ("hall_voltage",), "scale", on=("valve",)),
    Made("sensor: zero off by 1 V", measured(lambda v: v + 1.0), ("hall_voltage",), "zero", on=("valve",)),
    Made("sensor: zero off by -0.4 V", measured(lambda v: v - 0.4), ("hall_voltage",), "zero", on=("valve",)),
    Made("sensor: degrees for radians", measured(np.rad2deg), ("position",), "degrees", on=("bench",)),
    Made("sensor: counts, 4096 a turn", measured(lambda a: np.round(a * 4096 / 2 / np.pi)), ("position",), "counts", on=("bench",)),
    Made("sensor: turns for radians", measured(lambda a: a / 2 / np.pi), ("position",), "turns", on=("bench",)),
    Made("sensor: radians taken for degrees", measured(np.deg2rad), ("position",), "degrees", on=("bench",)),
    Made("sensor: constant", measured(lambda v: np.full_like(v, v[0])), ("hall_voltage", "position"), "constant"),
    Made("time: milliseconds for seconds", timed(1e3), ("time",), "unit: ms"),
    Made("time: microseconds for seconds", timed(1e6), ("time",), "unit: us"),
    Made("time: nanoseconds for seconds", timed(1e9), ("time",), "unit: ns"),
    Made("time: a thousandth", timed(1e-3), ("time",), "seconds"),
    Made("supply voltage: millivolts for volts", supply(lambda v: 1e3 * v), ("supply_voltage",), "millivolts"),
)  # fmt: skip


def told(make: Make, one: Recording, other: Recording, nominal: Model) -> list[str] | None:
    """What is said of a faulty recording, a line each; None where the fault cannot be made of it."""
    try:
        made = make(one, other)
        return [str(fault) for fault in audit(made, nominal)] if made else None
    except InputError as refused:
        return [str(refused)]


def is_found(fault: Made, lines: list[str]) -> bool:
    """Whether one of the lines blames a right signal in the right words."""
    return any(any(signal in line for signal in fault.signals) and fault.named in line for line in lines)
