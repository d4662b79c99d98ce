"""The time of a message: stamp, `/clock`, publish or log time, and never two clocks in one recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError
from pierburg_ros.recording.decoding import DECODERS, numbers
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.definitions import HEADER, first_field
from pierburg_ros.recording.formats.messages import LATEST, Integers, Messages
from pierburg_ros.recording.signal_map import TimeSource
from pierburg_ros.recording.signals import MEASURED
from pierburg_ros.recording.topics import Found, Topics

STAMPED_BESIDE = ("hall_voltage", "applied_duty")
"""Signals that the plant publishes once for each `joint_states`, so that they share its stamp."""
HEADER_STAMP = "header.stamp"
"""The path of the stamp in messages that begin with a header; it stands at one place in all of them."""
SHARED = 0.9
"""Least share of the range of sequence numbers that two topics of one tick have in common."""
CLOCK_TOLERANCE = 0.1
"""Largest typical difference [s] between two channels: above a delay on the way, below a wrong clock."""
LATCHED = 86_400.0
"""Largest age [s] of a message that was published before the recording began."""
FEW = 10
"""A channel of fewer messages may hold such old ones only."""


@dataclass(frozen=True)
class Timed:
    """The messages of a signal that have a time [ns], and the clock it comes from."""

    found: Found
    kept: NDArray[np.bool_]
    time: Integers
    source: str

    @property
    def messages(self) -> Messages:
        """The messages, those without a time among them."""
        return self.found.messages


def check_forward(name: str, timed: Timed) -> None:
    """Refuse messages whose times run backwards in the order of the file."""
    backwards = np.flatnonzero(np.diff(timed.time) < 0)
    if backwards.size:
        place = int(backwards[0])
        step = (timed.time[place] - timed.time[place + 1]) * 1e-9
        raise InputError(
            f"{name}: {timed.messages.topic} has a clock running backwards by {step:.3g} s after {place + 1}"
            f" messages ({timed.source} time), expected times that never decrease. Cut the recording there,"
            " or choose another clock with --time {stamp,clock,publish,log}."
        )


class Clocks:
    """Times the messages of a recording, by the clock a person chose or else by the best one recorded."""

    def __init__(self, topics: Topics, choice: str | None) -> None:
        self.name = topics.bag.name
        self.choice = choice
        self.asked = topics.chosen.time
        self.others = topics.stamped() if choice in (None, "stamp") else None
        self.stamps = None if self.others is None else self.own_stamps(self.others)
        self.ticks = topics.ticks() if choice in (None, "clock") else None
        if self.asked and self.others is not None and self.others.type == cdr.CLOCK:
            self.choice, self.ticks = "clock", self.others
        self.sources = {
            "stamp": self.stamped,
            "clock": self.clocked,
            "publish": self.published,
            "log": self.logged,
        }

    def time(self, found: Found) -> Timed | None:
        """The messages of a signal with their times; None where the chosen clock has none for them."""
        for source in self.sources if self.choice is None else (self.choice,):
            times = self.sources[source](found.signal, found.messages)
            if times is not None:
                timed = Timed(found, *times, source)
                check_forward(self.name, timed)
                return timed
        return None

    def stamped(self, signal: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Stamps that the messages carry, or those of joint states that the plant publishes beside them."""
        stamps = self.own_stamps(messages)
        if stamps is not None:
            return np.ones(len(messages), bool), stamps
        if self.others is None or self.stamps is None or signal not in STAMPED_BESIDE:
            return None
        return matched(messages, self.others, self.stamps)

    def own_stamps(self, messages: Messages) -> Integers | None:
        """Stamps [ns] in the messages themselves: in the field of a map, or else in their header."""
        asked, headed = self.asked, is_headed(messages)
        if asked is not None and asked.path is not None and self.others is not None:
            same = messages.topic == asked.topic or messages.type == self.others.type
            if same and not (headed and asked.path.written == HEADER_STAMP):
                return asked_stamps(messages, asked)
        stamps = cdr.stamp(messages) if headed else None
        return stamps if stamps is not None and np.any(stamps) else None

    def clocked(self, signal: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """The last `/clock` before each message; samples before the first go, inputs begin with it."""
        if self.ticks is None:
            return None
        place = np.searchsorted(self.ticks.place, messages.place) - 1
        kept = (place >= 0) | (signal not in MEASURED)
        return kept, cdr.stamp(self.ticks)[np.maximum(place[kept], 0)]

    def published(self, signal: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Publish times, where the file has them."""
        return (np.ones(len(messages), bool), messages.publish_time) if np.any(messages.publish_time) else None

    def logged(self, signal: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Log times, which every file has."""
        return np.ones(len(messages), bool), messages.log_time


def is_headed(messages: Messages) -> bool:
    """Whether the type of the messages begins with a std_msgs/Header, and so with a stamp."""
    if not len(messages) or messages.encoding != "cdr":
        return False
    if messages.type == cdr.JOINT_STATE:
        return True
    return messages.type not in DECODERS and first_field(messages.type, messages.definition) == HEADER


def asked_stamps(messages: Messages, asked: TimeSource) -> Integers:
    """The stamps [ns] in the field that a map names; a number is in the unit of the map."""
    read = numbers(messages, asked.path, asked.origin)
    if not np.all(read.kept):
        raise InputError(f"{asked.origin}: {messages.topic} has messages without that field, expected a time in each.")
    if read.is_stamp:
        return read.raw.astype(np.int64)
    factor = round(asked.unit * 1e9)
    largest = float(np.max(np.abs(read.raw.astype(np.float64)), initial=0.0))
    if not largest * factor < LATEST:
        raise InputError(
            f"{asked.origin}: {messages.topic} has the time {largest:g} in units of {asked.unit:g} s, expected one"
            " before the year 2262. Check the unit: s, ms, us or ns."
        )
    return read.raw * factor if read.raw.dtype == np.int64 else np.round(read.raw * factor).astype(np.int64)


def matched(messages: Messages, stamped: Messages, stamps: Integers) -> tuple[NDArray[np.bool_], Integers] | None:
    """Stamps for the messages that were published one for each of `stamped`; None where they were not.

    Sequence numbers match them where both have them, and a gap in the stamps is bridged between its
    neighbours; otherwise they match by order, which needs equally many.
    """
    if numbered(messages) and numbered(stamped):
        kept = (messages.sequence >= stamped.sequence[0]) & (messages.sequence <= stamped.sequence[-1])
        ranges = [(each.sequence[0], each.sequence[-1]) for each in (messages, stamped)]
        shared = min(last for _, last in ranges) - max(first for first, _ in ranges)
        if shared < SHARED * max(last - first for first, last in ranges):
            return None
        since = np.interp(messages.sequence[kept], stamped.sequence, stamps - stamps[0])
        return kept, stamps[0] + np.round(since).astype(np.int64)
    return (np.ones(len(messages), bool), stamps) if len(messages) == len(stamped) else None


def numbered(messages: Messages) -> bool:
    """Whether the messages carry sequence numbers of one publisher."""
    return bool(np.all(np.diff(messages.sequence) > 0))


def check_one_clock(name: str, measured: Timed, other: Timed) -> None:
    """Refuse `other` if its times tell another order of events than the arrival of the messages does.

    A message that arrived together with a measured sample must have its time, but for the delay on the way.
    """
    arrival, samples = other.messages.log_time[other.kept], measured.messages.log_time[measured.kept]
    inside = arrival <= samples[-1]
    few = arrival.size < FEW
    if not few:
        inside &= arrival >= samples[0]
    if samples[-1] <= samples[0] or not np.any(inside):
        return
    origin = measured.time[0]
    expected = np.interp(arrival[inside] - samples[0], samples - samples[0], measured.time - origin)
    late = float(np.median(expected - (other.time[inside] - origin))) * 1e-9
    pace = (measured.time[-1] - origin) / (samples[-1] - samples[0])
    tolerance = CLOCK_TOLERANCE * max(1.0, pace)
    if not -tolerance <= late <= (LATCHED if few else tolerance):
        raise InputError(
            f"{name} has times from two clocks: {measured.messages.topic} ({measured.source}) and"
            f" {other.messages.topic} ({other.source}) differ by {abs(late):.3g} s, expected one clock."
            " Choose it with --time {stamp,clock,publish,log}."
        )
