"""Recordings from files."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.actuators.units import unit_of
from pierburg_ros.errors import InputError, near
from pierburg_ros.intake import path_of
from pierburg_ros.library import recording
from pierburg_ros.library.model import ActuatorLike
from pierburg_ros.recording import Recording, read_recording
from pierburg_ros.recording.recording import Samples
from pierburg_ros.recording.signal_map import SignalMap, signal_map
from pierburg_ros.recording.signals import DRIVING, SIGNALS

Readable: TypeAlias = Recording | str | Path
"""A recording, or where one lies."""


def read(
    path: str | Path,
    *,
    time: str | None = None,
    topics: Mapping[str, str] | None = None,
    signals: str | Path | Mapping[str, Any] | SignalMap | None = None,
    actuator: ActuatorLike | None = None,
    exact: str | Sequence[str] = (),
) -> recording.Recording:
    """The recording at `path`: an MCAP file, a rosbag2 directory, or a CSV.

    A CSV has a header with `time` [s], an input, `duty` [1, from -1 to 1], `current` [A] or `torque` [N.m], and
    `hall_voltage` [V], `position` [rad] or `speed` [rad/s]. Where there are several, those of the `actuator` are
    taken. `signals` is a signal map, as a path or a mapping: which topic and field, or which column, each signal comes
    from, and in which unit. `topics` names the topic (in a CSV the column) of a signal; `time` chooses the clock:
    stamp, clock, publish or log. Signals that are `exact` are what they are read as: no fault of them is looked for.
    The result has `time` [s] and `measured`, both of shape (samples,), the `command`
    that drove the actuator and the other channels that acted. InputError says what is missing, and how to name it.

        recording = pr.read("bench.csv", topics={"duty": "pwm"})
    """
    place, chosen = path_of(path, "a recording, or the path of one"), signal_map(signals, topics or {})
    described = actuator if actuator is None or isinstance(actuator, Actuator) else read_actuator(actuator)
    preferred = () if described is None else (described.input, described.quantity)
    if described is not None:
        check_motion(chosen, described)
    found = read_recording(place, time=time, signals=chosen, preferred=preferred)
    found = replace(found, exact=found.exact | certain(names(exact)))
    return recording.Recording(**{**vars(found), "read_with": tuple(options(time, topics or {}, signals))})


def names(given: str | Collection[str]) -> Collection[str]:
    """One or more names as several."""
    return [given] if isinstance(given, str) else given


def certain(exact: Collection[str]) -> frozenset[str]:
    """The inputs and quantities that are said to be exact, by the names of their signals."""
    for signal in exact:
        if signal not in SIGNALS:
            raise InputError(
                f"--exact found {signal!r}, expected one of {', '.join(SIGNALS)}.{near(signal, SIGNALS)}"
                " Write --exact duty."
            )
    return frozenset(DRIVING.get(signal, signal) for signal in exact)


def options(time: str | None, topics: Mapping[str, str], signals: object) -> Iterator[str]:
    """The options with which a command reads a recording alike; a signal map that is no file has none."""
    if isinstance(signals, (str, Path)):
        yield from ("--signals", str(signals))
    for signal, name in topics.items():
        yield from ("--topic", f"{signal}={name}")
    if time is not None:
        yield from ("--time", time)


def check_motion(chosen: SignalMap, actuator: Actuator) -> None:
    """Refuse lengths for a rotary actuator, and angles for a linear one."""
    for signal, source in chosen.sources.items():
        expected = unit_of(SIGNALS[signal].units[0], actuator.motion)
        if source.measures not in ("", expected):
            raise InputError(
                f"{source.origin} is in a unit of {source.measures}, expected one of {expected}:"
                f" {actuator.name} is {actuator.motion}. Correct the unit, or give another --actuator."
            )


def recordings_of(given: Readable | Sequence[Readable], actuator: Actuator) -> list[Recording]:
    """One or more recordings of an `actuator` as a list, those given by path read; InputError where there is none."""
    several = list(given) if isinstance(given, (Sequence, Iterator)) and not isinstance(given, str) else [given]
    if not several:
        raise InputError("There is no recording; expected one or more. Give recordings or their paths.")
    found = [each if isinstance(each, Recording) else read(each, actuator=actuator) for each in several]
    refuse_repeated(found)
    return found


def refuse_repeated(recordings: Sequence[Recording]) -> None:
    """Refuse a recording that is given twice: its samples would count as twice as many, and narrow every interval."""
    for first, second in combinations(recordings, 2):
        if all(map(np.array_equal, signals_of(first), signals_of(second))):
            raise InputError(
                f"{first.name} and {second.name} are the same recording, expected different ones: its samples would"
                " count twice. Leave one out."
            )


def signals_of(recording: Recording) -> tuple[Samples, ...]:
    """Times [s] and values of what was measured and of what drove it, each of shape (samples,) or (changes,)."""
    return recording.time, recording.measured, recording.command.time, recording.command.values


def taken_up(measured: Recording) -> str:
    """What to add about a recording whose input is not known at first, and that is taken up later; else nothing."""
    begin = measured.time[0]
    return f"; simulated from {begin:.2f} s on, where its input is known" if begin > 0.0 else ""
