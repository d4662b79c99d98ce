"""The time of a message: stamp, `/clock`, publish or log time, and never two clocks in one recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.messages import Integers, Messages
from pierburg_ros.recording.roles import MEASURED, Topics

STAMPED_BESIDE = ("hall_voltage", "applied_duty")
"""Topics that the plant publishes once for each `joint_states`, so that they share its stamp."""
SHARED = 0.9
"""Least share of the range of sequence numbers that two topics of one tick have in common."""
TOLERANCE = 0.1
"""Largest typical difference [s] between two channels: above a delay on the way, below a wrong clock."""
LATCHED = 86_400.0
"""Largest age [s] of a message that was published before the recording began."""
FEW = 10
"""A channel of fewer messages may hold such old ones only."""


@dataclass(frozen=True)
class Timed:
    """The messages of a role that have a time [ns], and the clock it comes from."""

    messages: Messages
    kept: NDArray[np.bool_]
    time: Integers
    source: str


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
        self.joints = topics.find("joint_states") if choice in (None, "stamp") else None
        self.stamps = np.zeros(0, np.int64) if self.joints is None else cdr.stamp(self.joints)
        self.ticks = topics.find("clock") if choice in (None, "clock") else None
        self.sources = {
            "stamp": self.stamped,
            "clock": self.clocked,
            "publish": self.published,
            "log": self.logged,
        }

    def time(self, role: str, messages: Messages) -> Timed | None:
        """The messages of `role` with their times; None where the chosen clock has none for them."""
        for source in self.sources if self.choice is None else (self.choice,):
            found = self.sources[source](role, messages)
            if found is not None:
                timed = Timed(messages, *found, source)
                check_forward(self.name, timed)
                return timed
        return None

    def stamped(self, role: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Stamps of `joint_states`, for itself and for what the plant publishes beside it."""
        if self.joints is None or not np.any(self.stamps):
            return None
        if role == "joint_states":
            return np.ones(len(messages), bool), self.stamps
        return matched(messages, self.joints, self.stamps) if role in STAMPED_BESIDE else None

    def clocked(self, role: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """The last `/clock` before each message; samples before the first go, inputs begin with it."""
        if self.ticks is None:
            return None
        place = np.searchsorted(self.ticks.place, messages.place) - 1
        kept = (place >= 0) | (role not in MEASURED)
        return kept, cdr.stamp(self.ticks)[np.maximum(place[kept], 0)]

    def published(self, role: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Publish times, where the file has them."""
        return (np.ones(len(messages), bool), messages.publish_time) if np.any(messages.publish_time) else None

    def logged(self, role: str, messages: Messages) -> tuple[NDArray[np.bool_], Integers] | None:
        """Log times, which every file has."""
        return np.ones(len(messages), bool), messages.log_time


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
    tolerance = TOLERANCE * max(1.0, pace)
    if not -tolerance <= late <= (LATCHED if few else tolerance):
        raise InputError(
            f"{name} has times from two clocks: {measured.messages.topic} ({measured.source}) and"
            f" {other.messages.topic} ({other.source}) differ by {abs(late):.3g} s, expected one clock."
            " Choose it with --time {stamp,clock,publish,log}."
        )
