"""The initial state for the simulation of a recording: from which sample, at which angle, how fast."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit, begun, decoded_value
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of

EVEN = 50
"""Number of samples that, if they lie on a line, give its start and how fast the shaft creeps. Derived: the start of a
line through 50 samples is known to 2 / sqrt(50) = 0.28 of the noise."""
LONGEST = 5 * EVEN
"""Largest number of samples at the start of a recording that determine where the shaft stood. Derived: their mean is
known to a sixteenth of the noise, below what any later sample shows."""
FEWEST = 10
"""Smallest number of samples for which a shaft that keeps its place stands still, though it sets off then. Derived:
their mean is known to a third of the noise."""
SHORTEST = 8
"""Number of samples for a line where the shaft moves at once. Chosen: more samples would bend, fewer say nothing; not
varied."""
LATEST = 0.25
"""Share of a recording within which a standstill must come for the simulation to start there. Chosen: three quarters of
a recording remain; not varied."""
SLOW = 10.0
"""Largest span of the samples of a standstill, in units of the noise: creeping is allowed. Derived: 50 samples of white
noise alone span 4.5 on average; the rest is room to creep."""
BRISK = 40.0
"""Largest span, in units of the noise, for which a line at the start gives the velocity well enough. Measured: with
these rules 508 of n = 522 starts within three synthetic recordings leave at most 1.06 times the noise."""
CERTAIN = 4.0
"""Number of standard deviations of its own noise from which a slope or a bend is certain. Measured: white noise bends
so far in 22 of n = 449,020 windows (6e-5 expected), and slopes so far in none of 1,000."""
STOP = 3.0
"""Number of noises of the first samples within which a shaft is taken to start on a stop, or at rest. Derived: white
noise stays within with 99.7 %."""
ROUNDING = 2e-13
"""Difference that counts as none where there is no noise, as a share of the largest value. Derived: the mean of 250
samples is rounded by less than 250 x 1.1e-16 = 2.8e-14 of them."""


@dataclass(frozen=True)
class InitialState:
    """The state at the start of a recording: level, rate [1/s], curvature [1/s^2] and noise, in the measured unit.

    It is `known` where the shaft stands still or creeps. Where the speed is measured, `angle` [rad] is the angle if
    known from elsewhere. Otherwise the shaft is taken to start where its load lets it rest. Before, the measured value
    `came` rising (+1) or falling (-1); 0 where that is not known.
    """

    level: float
    rate: float
    noise: float
    known: bool
    angle: float = math.nan
    curvature: float = 0.0
    came: float = 0.0

    @staticmethod
    def of(time: Signal, measured: Signal, before: Signal | None = None) -> InitialState:
        """The state from the mean of the samples before the first movement, or from a line through the first samples.

        The line is for a shaft that creeps or moves at once. `before` is the signal measured until then, if any.
        """
        noise = noise_of(time, measured)
        length = _stays(measured[:LONGEST], noise)
        even = bool(_even(_windows(measured[:EVEN]), BRISK * noise, noise).any())
        while length >= 2 * FEWEST and _bent(measured[:length], noise, _rounding(measured)):
            length //= 2
        known = even or length >= FEWEST
        length = min(max(length, EVEN if even else FEWEST if known else SHORTEST), measured.size)
        elapsed, first = time[:length] - time[0], measured[:length]
        if known and not _slopes(elapsed, first, noise):
            level = float(np.mean(first))
            return InitialState(level, 0.0, noise, known, came=approach(before, level, noise))
        rate, level = np.polyfit(elapsed, first, 1)
        return InitialState(float(level), float(rate), noise, known)

    def state(self, model: Model, quantity: str) -> tuple[float, float, float, float]:
        """Angle [rad], velocity [rad/s] and acceleration [rad/s^2] at the first sample, and the direction of approach.

        The acceleration matters to a slow sensor. The direction matters to a sensor with play: opening (+1), closing
        (-1), or 0 where it is not known. The angle is exactly on a stop where noise allows it.
        """
        if quantity == "speed":
            return self._turning(model)
        angle, velocity, acceleration, came = begun(model, np.array([self.shown]), quantity)[0].tolist()
        return angle, velocity, acceleration, came

    @property
    def shown(self) -> tuple[float, float, float, float, float]:
        """The values from which `plant.decode.begun` derives the state."""
        return self.level, self.rate, self.curvature, STOP * self.noise, self.came

    def _turning(self, model: Model) -> tuple[float, float, float, float]:
        """The same state where the speed is measured; at rest where noise allows it."""
        angle = rest_angle(model) if math.isnan(self.angle) else self.angle
        velocity = decoded_value(model, self.level, "speed")
        margin = STOP * self.noise * abs(angle_per_unit(model))
        return angle, 0.0 if abs(velocity) <= margin else velocity, 0.0, 0.0


def rest_angle(model: Model) -> float:
    """Angle at which an actuator without input rests [rad]: on its stop, at the end of its spring, or hanging down."""
    value, actuator = model.values, model.actuator
    stiffness = value.get("spring_stiffness", 0.0)
    relaxed = -value.get("spring_preload", 0.0) / stiffness if stiffness > 0.0 else 0.0
    return min(max(relaxed, actuator.lower_stop), actuator.upper_stop)


def from_standstill(recording: Recording, nominal: Model) -> Recording:
    """`recording` from where the shaft first rests, or at least creeps; unchanged where its start is known.

    It is also unchanged where the shaft starts on a stop of the `nominal` actuator, or does not stand still soon. Its
    time is unchanged. The first samples of a standstill are left out as well: the end of the movement hides in their
    noise. Samples determine poorly how fast a shaft moves. A simulation that begins with a small error then rests
    elsewhere until the next stop, since dry friction lets the shaft rest anywhere.
    """
    start = InitialState.of(recording.time, recording.measured)
    if start.known or start.state(nominal, recording.quantity)[1] == 0.0:
        return recording
    soon = recording.measured[: int(LATEST * recording.measured.size)]
    sample = first_rest(soon, start.noise) or first_standstill(soon, start.noise)
    if sample is None:
        return recording
    return replace(recording, time=recording.time[sample:], measured=recording.measured[sample:])


def first_standstill(measured: Signal, noise: float) -> int | None:
    """The first sample of `measured` from which the shaft stands still or creeps; None where there is none."""
    still = _even(_windows(measured), SLOW * noise, noise)
    lasting = still[: -EVEN // 2] & still[EVEN // 2 :]
    return int(np.argmax(lasting)) + EVEN // 2 if lasting.any() else None


def first_rest(measured: Signal, noise: float) -> int | None:
    """The first sample of `measured` from which the shaft stands still and no longer creeps; None where there is none.

    The shaft rests where the means of two successive stretches of `EVEN` samples differ by no more than their noise.
    The rest starts with the second stretch, since the first may hold the end of the movement.
    """
    sample = first_standstill(measured, noise)
    if sample is None:
        return None
    rests = _keeps_place(measured[sample:], 2.0 * noise)
    return sample + EVEN * (int(np.argmax(rests)) + 1) if rests.any() else None


def keeps_still(time: Signal, measured: Signal, noise: float) -> bool:
    """Whether successive samples are those of a shaft at rest; False for fewer than `EVEN` samples."""
    windows = _windows(measured)
    return bool(_even(windows, SLOW * noise, noise).all() and windows.size) and not _slopes(time, measured, noise)


def approach(before: Signal | None, level: float, noise: float) -> float:
    """Whether the signal `before` a rest at a `level` rose (+1) or fell (-1) to it; 0 where that is not detected."""
    if before is None:
        return 0.0
    elsewhere = before[np.abs(before - level) > SLOW * noise]
    return float(np.sign(level - elsewhere[-1])) if elsewhere.size else 0.0


def rests_of(measured: Signal, noise: float) -> list[slice]:
    """The middle half of each rest: of stretches of `EVEN` samples whose means differ by their noise alone.

    The value of a part that begins at a rest depends on how well the mean of the rest is known. With two stretches of
    each rest instead of its middle half, 2 of 12 searches from far away missed the minimum; with the middle half none
    did.
    """
    blocks = measured[: measured.size // EVEN * EVEN].reshape(-1, EVEN)
    even = _even(blocks, SLOW * noise, noise)
    rests = _keeps_place(measured, CERTAIN * noise) & even[:-1] & even[1:]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rests, [False]])))
    found = []
    for first, last in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        start, stop = EVEN * first, EVEN * (last + 1)
        found.append(slice(start + (stop - start) // 4, stop - (stop - start) // 4))
    return found


def _keeps_place(measured: Signal, deviation: float) -> NDArray[np.bool_]:
    """Whether each stretch of `EVEN` samples has the mean of the next, except for samples off by a `deviation`."""
    means = measured[: measured.size // EVEN * EVEN].reshape(-1, EVEN).mean(axis=1)
    return np.asarray(np.abs(np.diff(means)) <= deviation * np.sqrt(2.0 / EVEN) + _rounding(measured))


def _rounding(measured: Signal) -> float:
    """Difference between samples that counts as none [measured unit]."""
    return ROUNDING * float(np.max(np.abs(measured), initial=0.0))


def _stays(measured: Signal, noise: float) -> int:
    """Number of samples from the first on that keep its place, within five times the noise."""
    still = np.abs(measured - np.median(measured[:5])) <= 5.0 * noise + _rounding(measured)
    return int(np.argmin(still)) if not still.all() else still.size


def _slopes(time: Signal, measured: Signal, noise: float) -> bool:
    """Whether samples certainly rise or fall."""
    elapsed = time - np.mean(time)
    return bool(
        abs(elapsed @ measured)
        > CERTAIN * noise * np.linalg.norm(elapsed) + _rounding(measured) * float(np.sum(np.abs(elapsed)))
    )


def _bent(windows: Signal, noise: float, rounding: float) -> NDArray[np.bool_]:
    """Whether successive samples, along the last axis, certainly do not lie on a straight line.

    On a line the middle third has the mean of the outer two, except for the noise of these means.
    """
    third = max(windows.shape[-1] // 3, 1)
    parts = (windows[..., :third], windows[..., third:-third], windows[..., -third:])
    first, middle, last = (np.mean(part, axis=-1) for part in parts)
    return np.asarray(np.abs(first + last - 2.0 * middle) > CERTAIN * noise * np.sqrt(6.0 / third) + rounding)


def _even(windows: Signal, span: float, noise: float) -> NDArray[np.bool_]:
    """Whether successive samples, along the last axis, lie on a line and within a `span`."""
    rounding = _rounding(windows)
    return np.asarray((np.ptp(windows, axis=-1) <= span + rounding) & ~_bent(windows, noise, rounding))


def _windows(measured: Signal) -> Signal:
    """Windows of `EVEN` samples from each sample on, shape (windows, EVEN); none where there are too few samples."""
    if measured.size < EVEN:
        return np.zeros((0, EVEN))
    return np.asarray(np.lib.stride_tricks.sliding_window_view(measured, EVEN))
