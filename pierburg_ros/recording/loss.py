"""What is missing in a recording: messages by the senders' numbers, and stretches by the time between samples."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal

Span = tuple[float, float]
"""Start and end [s]."""

LOSSES = "pierburg_ros_losses"
"""Name of the MCAP metadata record in which the recorder says, by topic, how many messages it lost."""
IN_SEQUENCE = 0.5
"""Least share of steps by one in a topic's own numbering. Numbers that count all topics or rows of a file together
step by one in less, and say nothing about one topic; a topic that lost half of its messages one by one is taken for
such a one, and then only its long gaps are found."""
RESTARTS = 0.01
"""Largest share of steps back: a publisher may be started again, but two that are numbered apart go back all the
time."""
FAR = 5.0
"""Times the usual interval from which on an interval is a gap, where messages have no numbers. The longest interval is
1.0 times the usual one in the practice recordings and at most 1.27 times on the measured bench. At a load
of 27 a plant stood still for up to 1.3 s, 71 times the usual interval, and 327 of 318,866 intervals were too long:
without numbers that cannot be told from a loss, and with them nothing was lost."""
USUAL_QUANTILE = 0.95
"""Quantile of the intervals that is usual; with it one interval in twenty may be a gap."""
REPEATED = 0.1
"""Least share of values equal to the one before in a channel that is sent regularly. What is sent on change repeats
none, and its silence is no gap; what repeats a tenth has no reason to be silent."""

EVEN = 0.05
"""How far nearly all intervals may be from whole multiples of the usual one, in usual ones, for the clock to be even:
it ticks on where rows are lost. On the measured bench and with a tenth of a period of jitter they are off by 0.08."""
MOSTLY = 0.99
"""Share of intervals that are nearly all."""
SINGLE = 0.7
"""Least share of intervals of one tick; with less, ticks are skipped by who sends, not lost."""


@dataclass(frozen=True)
class Loss:
    """Messages that are missing in a signal: how many, of how many sent, and the spans [s] in which they are.

    `lost` is None where the file has no numbers of the sender's; then the spans are those without any message.
    """

    signal: str
    lost: int | None
    sent: int
    spans: tuple[Span, ...]

    def __str__(self) -> str:
        """As people read it: `duty 2 of 100 messages`."""
        name = self.signal.replace("_", " ")
        if self.lost is not None:
            return f"{name} {self.lost} of {self.sent} messages"
        return f"{name} silent for {sum(end - start for start, end in self.spans):.3g} s"


def are_numbered(sequence: NDArray[np.int64]) -> bool:
    """Whether `sequence` numbers the messages of this topic alone, so that a step by more than one is a loss."""
    steps = np.diff(sequence)
    return bool(steps.size and np.mean(steps == 1) >= IN_SEQUENCE and np.mean(steps <= 0) <= RESTARTS)


def numbered_loss(signal: str, time: Signal, sequence: NDArray[np.int64]) -> Loss:
    """What the numbers of messages at `time` [s] say is missing."""
    steps = np.diff(sequence)
    after = np.flatnonzero(steps > 1)
    lost = int(np.sum(steps[after] - 1))
    spans = tuple((float(time[place]), float(time[place + 1])) for place in after)
    return Loss(signal, lost, int(time.size) + lost, spans)


def pauses(time: Signal) -> tuple[Span, ...]:
    """Spans between samples at `time` [s] that are far longer than usual, or of an even clock those without a tick."""
    interval = np.diff(time)
    if not interval.size:
        return ()
    ticks = interval / max(float(np.median(interval)), np.finfo(float).tiny)
    whole = np.maximum(np.round(ticks), 1.0)
    even = np.quantile(np.abs(ticks - whole), MOSTLY) <= EVEN and np.mean(whole == 1.0) >= SINGLE
    far = FAR * max(np.quantile(interval, USUAL_QUANTILE), np.finfo(float).tiny)
    long = np.flatnonzero(whole > 1.0 if even else interval > far)
    return tuple((float(time[place]), float(time[place + 1])) for place in long)


def silences(time: Signal, values: Signal, measured_pauses: tuple[Span, ...]) -> tuple[Span, ...]:
    """Spans in which an input without numbers is unknown.

    A channel that is sent regularly is unknown where it pauses. Whatever way it is sent, it is unknown where the
    measured signal pauses and nothing of it came either: nothing was recorded there.
    """
    own = pauses(time) if values.size > 1 and np.mean(np.diff(values) == 0.0) >= REPEATED else ()
    shared = tuple(span for span in measured_pauses if not np.any((time > span[0]) & (time < span[1])))
    return merged((*own, *shared))


def spans_of(time: NDArray[np.float64], found: NDArray[np.bool_], apart: int = 1) -> list[Span]:
    """The spans [s] in which samples at `time` [s] are `found`, those up to so many samples `apart` as one."""
    places = np.flatnonzero(found)
    groups = np.split(places, np.flatnonzero(np.diff(places) > apart) + 1)
    return [(float(time[group[0]]), float(time[group[-1]])) for group in groups if group.size]


def merged(spans: tuple[Span, ...]) -> tuple[Span, ...]:
    """The same spans in order, those that overlap as one."""
    found: list[Span] = []
    for start, end in sorted(spans):
        if found and start <= found[-1][1]:
            found[-1] = (found[-1][0], max(end, found[-1][1]))
        else:
            found.append((start, end))
    return tuple(found)


def within(losses: tuple[Loss, ...], start: float, end: float) -> tuple[Loss, ...]:
    """The losses that touch [start, end] [s], cut to it, with times counted from `start`."""
    found = []
    for loss in losses:
        spans = tuple(
            (max(first, start) - start, min(last, end) - start)
            for first, last in loss.spans
            if first < end and last > start
        )
        if spans:
            found.append(replace(loss, spans=spans))
    return tuple(found)


def sentence(losses: tuple[Loss, ...], name: str, unknown: tuple[Span, ...]) -> str:
    """What to say first of a recording that is not whole; nothing of one that is.

    `unknown` are the spans [s] in which the input of this `name` is not known.
    """
    if not losses:
        return ""
    missing = ", ".join(str(loss) for loss in losses)
    longest = max((end - start for start, end in unknown), default=0.0)
    without = (
        f" The {name} is unknown in {len(unknown)} stretches, {sum(end - start for start, end in unknown):.3g} s"
        f" together, the longest {longest:.3g} s."
        if unknown
        else ""
    )
    return f"Messages are missing: {missing}.{without}"
