"""A recording cut into pieces with a known input: the simulation starts again where messages are missing."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.memory import remaining, top_speed
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.loss import Span, merged
from pierburg_ros.recording.noise import noise_of

SEEN = 1.0
"""Error of the angle, in noises of the sensor, that one unknown stretch of the input may cause without the simulation
starting again after it. Derived: one noise of the sensor; a larger error would be detected."""

ALIKE = 0.05
"""Difference between the lengths of unknown stretches that counts as none, as a share of the shortest. Work: each
length is evaluated by itself."""
KNOWN = 1000
"""Number of moments at which the known duty is evaluated. Derived: their median is known to 1.25 / sqrt(1000) = 4 %."""


@dataclass(frozen=True)
class Pieces:
    """The parts of a recording that can be simulated, times unchanged.

    `uncertainty` is the standard deviation [measured unit] of the error that the losses within them may add. `left_out`
    are spans [s] whose input is not known.
    """

    parts: list[Recording]
    uncertainty: float
    left_out: tuple[Span, ...]


def pieces(recording: Recording, model: Model, without: tuple[Span, ...] = ()) -> Pieces:
    """`recording` cut where a missing duty may have moved the shaft by more than the noise, and `without` some spans.

    Elsewhere the duty is taken to have changed half way through: a duty held until the next message would always change
    late. The error that remains adds up over the time in which `model` forgets an error.
    """
    unknown = recording.unknown_input
    if not unknown:
        return Pieces(_cut(recording, without) if without else [recording], 0.0, ())
    per_radian = 1.0 / abs(angle_per_unit(model))
    starts, ends = (np.array([span[place] for span in unknown]) for place in (0, 1))
    moved = top_speed(model) * (ends - starts) * _doubt(recording.command, starts, ends) * per_radian
    doubtful = moved > SEEN * noise_of(recording.time, recording.measured)
    filled = replace(recording, command=_halved(recording.command, starts[~doubtful], ends[~doubtful]))
    left_out = tuple(span for span, cut in zip(unknown, doubtful, strict=True) if cut)
    added = remaining(moved[~doubtful], model, recording.duration)
    return Pieces(_cut(filled, merged((*left_out, *without))), added, left_out)


def _doubt(duty: Channel, starts: Signal, ends: Signal) -> Signal:
    """Error of the mean duty in each unknown span against the mean of the known duties on either side, shape (spans,).

    A step from one to the other may have come at any moment: its error is its size over the square root of 12. Other
    changes of the duty are estimated where it is known: the median error of the same mean over such a time. The larger
    error counts.
    """
    step = np.abs(duty.at(ends, before=0.0) - duty.at(starts, before=0.0)) / math.sqrt(12.0)
    begins = np.linspace(duty.time[0], duty.time[-1], KNOWN)
    told = ALIKE * float(np.min(ends - starts))
    lengths, place = np.unique(told * np.round((ends - starts) / told), return_inverse=True)
    wander = np.empty(lengths.size)
    for index, length in enumerate(lengths):
        inside = begins[:, None] + length * np.linspace(0.0, 1.0, 9)
        values = duty.at(inside.ravel(), before=0.0).reshape(inside.shape)
        error = values[:, :-1].mean(axis=1) - 0.5 * (values[:, 0] + values[:, -1])
        # the standard deviation of a normal distribution over its median absolute deviation is 1.4826
        wander[index] = 1.4826 * float(np.median(np.abs(error)))
    return np.maximum(step, wander[place])


def _halved(duty: Channel, starts: Signal, ends: Signal) -> Channel:
    """The duty with the mean of the values before and after each span in force until the end of the span."""
    if not starts.size:
        return duty
    interval = float(np.median(np.diff(duty.time)))
    moments = starts + np.minimum(interval, 0.5 * (ends - starts))
    means = 0.5 * (duty.at(starts, before=0.0) + duty.at(ends, before=0.0))
    times, values = np.concatenate([duty.time, moments]), np.concatenate([duty.values, means])
    order = np.argsort(times, kind="stable")
    return Channel(times[order], values[order])


def _cut(recording: Recording, doubtful: tuple[Span, ...]) -> list[Recording]:
    """The parts of `recording` between the `doubtful` spans."""
    edges = [(-math.inf, float(recording.time[0])), *doubtful, (float(recording.time[-1]), math.inf)]
    parts = []
    for (_, start), (end, _) in pairwise(edges):
        inside = (recording.time >= start) & (recording.time <= end)
        if np.count_nonzero(inside) >= 2:
            parts.append(replace(recording, time=recording.time[inside], measured=recording.measured[inside]))
    return parts
