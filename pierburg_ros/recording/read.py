"""Reads a recording from MCAP, a rosbag2 directory or CSV: what was measured, what drove it, on one clock.

Parameters, logs, diagnostics, metadata and attachments are never looked at.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pierburg_ros.errors import InputError
from pierburg_ros.intake import check_magnitude, reading
from pierburg_ros.recording.clocks import Clocks, Timed, check_one_clock
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.file_times import FileTimes
from pierburg_ros.recording.formats import format_of
from pierburg_ros.recording.formats.messages import Bag, Wanted
from pierburg_ros.recording.loss import Loss, are_numbered, numbered_loss, pauses, silences
from pierburg_ros.recording.recording import Channel, Recording, Samples
from pierburg_ros.recording.signal_map import Given, SignalMap, signal_map
from pierburg_ros.recording.signals import DRIVING, MEASURED, OPTIONAL, SIGNALS, TIME, in_order, last_name
from pierburg_ros.recording.tables import Tables, read_tables, tabulated
from pierburg_ros.recording.topics import TICKS, Found, Topics

SOURCES = ("stamp", "clock", "publish", "log")
LONGEST_RECORDING = 7 * 86_400.0
"""Time [s] that a recording may span: a week. What acts all the time is simulated in steps of 2 ms, and a week of them
takes about two minutes."""
SPARSEST = 60.0
"""Time [s] for each sample at most: no motion of an actuator shows in less than one sample a minute."""
UNITS_OF_TIME = {"ms": 1e-3, "us": 1e-6, "ns": 1e-9}
"""Smaller units [s] in which times may be written, the largest first."""
SLOW_INTERVAL = 0.2
"""Interval [s] below which samples of a motion usually lie."""
ACTING = ("supply_voltage", "enabled")
"""Optional signals without which the simulation of the recording would differ."""


def read_recording(
    path: str | Path,
    *,
    time: str | None = None,
    topics: Mapping[str, str] | None = None,
    signals: Given = None,
    preferred: Collection[str] = (),
) -> Recording:
    """The recording at `path`.

    `signals` is a signal map, its file or its content; `topics` names the topic (in a CSV the column) of a signal, e.g.
    {"duty": "/bench/pwm"}, in place of the map's; `time` chooses the clock, one of stamp, clock, publish and log,
    where the best one recorded is not wanted. `preferred` are the input and the quantity to take where the recording
    holds several, e.g. ("current", "speed").
    """
    path, chosen = Path(path), signal_map(signals, topics or {})
    if time is not None and time not in SOURCES:
        raise InputError(f"--time found {time!r}, expected one of {', '.join(SOURCES)}. Choose one of those.")
    with reading(path, "a recording"), np.errstate(all="ignore"):
        found = read_tables(path, chosen) if chosen.files else format_of(path).read(path, wanted(chosen))
        if isinstance(found, Bag):
            made = assemble(Topics(found, chosen), time, preferred)
        else:
            made = tabulated(Tables(found) if isinstance(found, Columns) else found, time, chosen, preferred)
        check_bounds(made)
    exact = {DRIVING.get(signal, signal) for signal, source in made.sources.items() if source.exact}
    return replace(made, path=path, exact=frozenset(exact))


def wanted(chosen: SignalMap) -> Wanted:
    """Whether a topic or a column may hold a signal, by its name."""
    topics = {name for signal in SIGNALS.values() for name in signal.topics} | {TICKS}
    columns = {*(signal.column for signal in SIGNALS.values()), TIME}
    return lambda name: last_name(name) in topics or name in columns or chosen.wants(name)


def check_bounds(recording: Recording) -> None:
    """Refuse what no bench gives: values beyond any sensor, and times that no motion needs."""
    longest = min(LONGEST_RECORDING, SPARSEST * recording.time.size)
    if not recording.duration <= longest:
        raise InputError(
            f"{recording.name} spans {recording.duration:.3g} s with {recording.time.size} samples, expected at most"
            f" {longest:,.0f} s. Check the unit of its times{_unit_of(recording)}, or cut it into parts."
        )
    check_magnitude(f"{recording.name}: {recording.quantity}", recording.measured)
    channels = {recording.input: recording.command, **{signal: getattr(recording, signal) for signal in OPTIONAL}}
    for signal, channel in channels.items():
        if channel is not None:
            check_magnitude(f"{recording.name}: {signal}", channel.values)
            check_magnitude(f"{recording.name}: time of {signal} [s]", channel.time)


def _unit_of(recording: Recording) -> str:
    """The line of a signal map with which samples would lie milliseconds apart, where a unit has that effect."""
    interval = float(np.median(np.diff(recording.time)))
    units = [unit for unit, seconds in UNITS_OF_TIME.items() if seconds * interval <= SLOW_INTERVAL]
    return f" (`time: {{unit: {units[0]}}}` in a signal map)" if units else ""


def assemble(topics: Topics, choice: str | None, preferred: Collection[str] = ()) -> Recording:
    """The recording that the messages of `topics` make, timed by the `choice` of clock."""
    name = topics.bag.name
    found = {
        "measured": first_of(topics, MEASURED, preferred, "measured signal"),
        "command": first_of(topics, DRIVING, preferred),
    }
    found |= {signal: each for signal in OPTIONAL if (each := topics.find(signal)) is not None}
    timed = timed_by(Clocks(topics, choice), found)
    for other in timed.values():
        check_one_clock(name, timed["measured"], other)
    origin = timed["measured"].time[0]
    channels = {signal: Channel(*samples(name, times, int(origin))) for signal, times in timed.items()}
    quantity, driven = MEASURED[found["measured"].signal], DRIVING[found["command"].signal]
    first = channels.pop("measured")
    sources = dict.fromkeys(timed[signal].source for signal in ("measured", "command"))
    losses = lost({**channels, "measured": first}, timed, {"measured": quantity, "command": driven})
    return Recording(
        name,
        quantity,
        first.time,
        first.values,
        **channels,
        time_source=", ".join(sources),
        losses=losses,
        input=driven,
        path=None,
        read_with=(),
        file_times=file_times(timed["measured"], first.time),
        sources={each.signal: each.source for each in found.values()},
        clock=topics.chosen.time,
        exact=frozenset(),
    )


def timed_by(clocks: Clocks, found: Mapping[str, Found]) -> dict[str, Timed]:
    """The signals that have a time; what drives the actuator and what was measured must have one."""
    timed: dict[str, Timed] = {}
    for signal, each in found.items():
        times = clocks.time(each)
        if times is not None and times.time.size:
            timed[signal] = times
        elif signal in ("measured", "command", *ACTING):
            raise InputError(
                f"{clocks.name}: {each.messages.topic} has no {clocks.choice} time, expected one for every message."
                " Choose another clock with --time {stamp,clock,publish,log}."
            )
    if clocks.asked and clocks.choice is None and all(times.source != "stamp" for times in timed.values()):
        raise InputError(
            f"{clocks.asked.origin} names stamps of {clocks.asked.topic}, which no signal shares, expected a topic that"
            " a signal comes from, or one with a message for each of its samples."
        )
    return timed


def lost(channels: Mapping[str, Channel], timed: Mapping[str, Timed], names: Mapping[str, str]) -> tuple[Loss, ...]:
    """What is missing in each signal: by its numbers, or else by pauses in what was measured and in the input."""
    found = []
    breaks = pauses(channels["measured"].time)
    for signal, channel in channels.items():
        name = names.get(signal, signal)
        sequence = timed[signal].messages.sequence[timed[signal].kept]
        if are_numbered(sequence):
            found.append(numbered_loss(name, channel.time, sequence))
        elif signal in names:
            spans = breaks if signal == "measured" else silences(channel.time, channel.values, breaks)
            found.append(Loss(name, None, channel.time.size, spans))
    return tuple(loss for loss in found if loss.spans)


def samples(name: str, timed: Timed, origin: int) -> tuple[Samples, Samples]:
    """Times [s] since `origin` [ns] and decoded values of the messages that have a time."""
    values = timed.found.values[timed.kept]
    time: Samples = (timed.time - origin).astype(np.float64) * 1e-9
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise InputError(
            f"{name}: {timed.messages.topic} has samples that are NaN or infinite ({bad.size} of {time.size},"
            f" first at {time[bad[0]]:.3f} s), expected finite numbers. Cut or repair the recording there."
        )
    return time, values


def file_times(timed: Timed, time: Samples) -> FileTimes:
    """When the messages of `timed` lie in their file, by their `time` [s] in the recording."""
    return FileTimes.of(time, timed.messages.log_time[timed.kept], timed.messages.publish_time[timed.kept])


def first_of(topics: Topics, signals: Mapping[str, str], preferred: Collection[str], what: str = "") -> Found:
    """The first of `signals` that has messages; only those that a person chose where there are such."""
    order = in_order(signals, topics.chosen.sources, preferred)
    for signal in order:
        if (found := topics.find(signal)) is not None:
            return found
    raise missing(topics, what or signals[order[0]], signals[order[0]], order)


def missing(topics: Topics, what: str, signal: str, signals: Sequence[str]) -> InputError:
    """What to say where none of `signals` has messages; a person may name a topic for `signal`."""
    name, option = topics.bag.name, f"--topic {signal}=/your/topic"
    if topics.bag.count == 0:
        return InputError(f"{name} holds no messages, expected a measured signal and what drove it. Record again.")
    empty = [topic for topic in map(topics.topic_of, signals) if topic is not None]
    if empty:
        return InputError(f"{name} has no messages on {empty[0]}, expected a {what}. Name another with {option}.")
    return InputError(
        f"{name} has no {what} topic (found: {topics.listed()}). Name it with {option}; pierburg inspect says what each"
        " could be."
    )
