"""Reads a recording from MCAP, a rosbag2 directory or CSV: what was measured, what drove it, on one clock.

Parameters, logs, diagnostics, metadata and attachments are never looked at.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.recording.clocks import Clocks, Timed, check_one_clock
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.csv_table import read_csv
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.formats.rosbag2 import read_bag
from pierburg_ros.recording.recording import Channel, Recording
from pierburg_ros.recording.roles import ROLES, Cast, check_names, last_name

SOURCES = ("stamp", "clock", "publish", "log")
DECODERS = {cdr.FLOAT64: cdr.float64, cdr.BOOL: cdr.boolean, cdr.JOINT_STATE: cdr.position}
OPTIONAL = ("supply_voltage", "temperature", "enabled", "setpoints")
ACTING = ("supply_voltage", "enabled")
"""Optional signals without which the simulation of the recording would differ."""


def read_recording(path: str | Path, *, time: str | None = None, topics: Mapping[str, str] | None = None) -> Recording:
    """The recording at `path`.

    `topics` names the topic (in a CSV the column) of a role, e.g. {"duty": "/bench/pwm"}; `time` chooses the
    clock, one of stamp, clock, publish and log, where the best one recorded is not wanted.
    """
    path, named = Path(path), dict(topics or {})
    if not path.exists():
        raise InputError(f"{path} does not exist, expected a recording. Check the path.")
    if time is not None and time not in SOURCES:
        raise InputError(f"--time found {time!r}, expected one of {', '.join(SOURCES)}. Choose one of those.")
    if path.suffix.lower() == ".csv":
        return read_csv(path, time, named)
    check_names(named, ROLES)
    bag = read_bag(path, lambda topic: last_name(topic) in ROLES or topic in named.values())
    return assemble(Cast(bag, named), time)


def assemble(cast: Cast, choice: str | None) -> Recording:
    """The recording that the messages of `cast` make, timed by the `choice` of clock."""
    name = cast.bag.name
    found = {"measured": measured(cast), "duty": duty(cast)}
    found |= {role: (role, messages) for role in OPTIONAL if (messages := cast.find(role)) is not None}
    clocks = Clocks(cast, choice)
    timed: dict[str, Timed] = {}
    for signal, (role, messages) in found.items():
        times = clocks.time(role, messages)
        if times is not None and times.time.size:
            timed[signal] = times
        elif signal in ("measured", "duty", *ACTING):
            raise InputError(
                f"{name}: {messages.topic} has no {choice} time, expected one for every message."
                " Choose another clock with --time {stamp,clock,publish,log}."
            )
    for signal in timed:
        check_one_clock(name, timed["measured"], timed[signal])
    origin = timed["measured"].time[0]
    channels = {signal: Channel(*samples(name, times, int(origin))) for signal, times in timed.items()}
    quantity = "hall_voltage" if found["measured"][0] == "hall_voltage" else "position"
    first = channels.pop("measured")
    sources = dict.fromkeys(timed[signal].source for signal in ("measured", "duty"))
    return Recording(name, quantity, first.time, first.values, **channels, time_source=", ".join(sources))


def samples(name: str, timed: Timed, origin: int) -> tuple[Signal, Signal]:
    """Times [s] since `origin` [ns] and decoded values of the messages that have a time."""
    values = DECODERS[timed.messages.type](timed.messages)[timed.kept]
    time: Signal = (timed.time - origin).astype(np.float64) * 1e-9
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise InputError(
            f"{name}: {timed.messages.topic} has samples that are NaN or infinite ({bad.size} of {time.size},"
            f" first at {time[bad[0]]:.3f} s), expected finite numbers. Cut or repair the recording there."
        )
    return time, values


def measured(cast: Cast) -> tuple[str, Messages]:
    """Role and messages of what was measured; Hall voltage before position."""
    for role in ("hall_voltage", "joint_states"):
        if (messages := cast.find(role)) is not None:
            return role, messages
    raise missing(cast, "measured signal", ("hall_voltage", "joint_states"))


def duty(cast: Cast) -> tuple[str, Messages]:
    """Role and messages of the input: what the plant says it applied, unless a person names a duty."""
    for role in ("duty",) if "duty" in cast.named else ("applied_duty", "duty"):
        if (messages := cast.find(role)) is not None:
            return role, messages
    raise missing(cast, "duty", ("duty", "applied_duty"))


def missing(cast: Cast, what: str, roles: tuple[str, ...]) -> InputError:
    """What to say where none of `roles` has messages."""
    name, option = cast.bag.name, f"--topic {roles[0]}=/your/topic"
    if cast.bag.count == 0:
        return InputError(f"{name} holds no messages, expected {' or '.join(roles)} and more. Record again.")
    empty = [topic for topic in (cast.topic(role) for role in roles) if topic is not None]
    if empty:
        return InputError(f"{name} has no messages on {empty[0]}, expected a {what}. Name another with {option}.")
    return InputError(f"{name} has no {what} topic (found: {cast.listed()}). Name it with {option}.")
