"""Mains hum on the sensor: a line at 50 or 60 Hz, or a multiple, that is present while the shaft stands still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

MAINS = (50.0, 60.0)
"""Frequencies [Hz] of the mains. Given: those of the world's grids."""
OFF = 0.2
"""Largest deviation of a grid's frequency [Hz]. Given: what ENTSO-E allows in normal operation."""
MULTIPLES = (1, 2, 3)
"""Multiples of the mains frequency that are searched. Chosen: rectifiers and iron cause mostly these; not varied."""
PERIOD = 0.1
"""Time [s] over which the hum averages to zero. Derived: five periods of 50 Hz and six of 60 Hz."""
STILL = 4.0
"""Largest difference of means over `PERIOD` while the shaft stands still, in standard deviations. Derived: noise
exceeds it with probability 6e-5."""
SHORTEST_STANDSTILL = 5.0
"""Shortest standstill [s] from which a line is reported. Derived: at 500 Hz, hum of a third of the noise is then
detected at 12 standard deviations, and frequencies are distinguished to 0.2 Hz."""
CERTAIN = 30.0
"""Gain in chi-squared from which a line counts as present. Derived: if 2000 lines are tried in noise alone, one gains
as much with probability 6e-4; twice `ln(2000)` is 15."""
HEARD = 0.25
"""Smallest amplitude of a line that is removed, in standard deviations of the noise. Measured: n = 29 weaker lines had
50 to 180 Hz at 200 to 2000 Hz. None gives evidence of more than 32 for a residual that is correlated in time. That is
half of the threshold for one."""


@dataclass(frozen=True)
class Line:
    """A sine of `frequency` [Hz]; its cosine and sine parts are in the measured unit."""

    frequency: float
    cosine: float
    sine: float

    @property
    def amplitude(self) -> float:
        """Amplitude, measured unit."""
        return float(np.hypot(self.cosine, self.sine))

    def at(self, time: Signal) -> Signal:
        """The line at `time` [s]."""
        turn = 2.0 * np.pi * self.frequency * time
        return np.asarray(self.cosine * np.cos(turn) + self.sine * np.sin(turn))


def hum(time: Signal, measured: Signal) -> list[Line]:
    """The mains lines in a measured signal, strongest first; none where the standstill is too short."""
    interval = float(np.median(np.diff(time)))
    still = standing(time, measured)
    if np.count_nonzero(still) * interval < SHORTEST_STANDSTILL:
        return []
    noise, found = noise_of(time, measured), []
    for frequency in (multiple * mains for multiple in MULTIPLES for mains in MAINS):
        if PERIOD * min(frequency, abs(1.0 / interval - frequency)) < 1.0:
            continue
        line, gained = _strongest(time, measured, still, frequency)
        if gained > CERTAIN and line.amplitude > HEARD * noise:
            found.append(line)
            measured = measured - line.at(time)
    return sorted(found, key=lambda line: -line.amplitude)


def standing(time: Signal, measured: Signal) -> Flags:
    """Which samples lie where the mean over `PERIOD` stays the same, shape (samples,)."""
    count = max(round(PERIOD / float(np.median(np.diff(time)))), 1)
    total = np.concatenate([[0.0], np.cumsum(measured)])
    mean = (total[count:] - total[:-count]) / count
    found = np.zeros(measured.size, dtype=bool)
    if mean.size <= 2 * count:
        return found
    limit = STILL * noise_of(time, measured) * np.sqrt(2.0 / count)
    same = np.abs(mean[2 * count :] - mean[: -2 * count]) <= limit
    even = time[3 * count - 1 :] - time[: -(3 * count - 1)] <= 1.5 * 3.0 * PERIOD
    found[count + count // 2 :][: same.size] = same & even[: same.size]
    return found


def _strongest(time: Signal, measured: Signal, still: Flags, about: float) -> tuple[Line, float]:
    """The line near a frequency that fits the standstill samples best, and its gain in chi-squared."""
    count = max(round(PERIOD / float(np.median(np.diff(time)))), 1)
    level = np.convolve(np.pad(measured, count // 2, mode="edge"), np.ones(count) / count, mode="same")
    rest = (measured - level[count // 2 : count // 2 + measured.size])[still]
    times = time[still]
    width = OFF * max(about / MAINS[0], 1.0)
    step = 0.5 / float(times[-1] - times[0])
    coarse = np.arange(about - width, about + width + step, step)
    fine = coarse[np.argmax(_gained(rest, times, coarse))] + np.linspace(-step, step, 17)
    gains = _gained(rest, times, fine)
    best = float(fine[np.argmax(gains)])
    turn = 2.0 * np.pi * best * times
    cosine, sine = np.linalg.lstsq(np.stack([np.cos(turn), np.sin(turn)], axis=1), rest, rcond=None)[0]
    return Line(best, float(cosine), float(sine)), float(gains.max())


def _gained(rest: Signal, times: Signal, frequencies: Signal) -> Signal:
    """Gain in chi-squared of a line at each of evenly spaced frequencies [Hz], shape (frequencies,)."""
    turned = rest * np.exp(-2j * np.pi * frequencies[0] * times)
    onward = np.exp(-2j * np.pi * (frequencies[1] - frequencies[0]) * times)
    sums = np.empty(frequencies.size, dtype=complex)
    for number in range(frequencies.size):
        sums[number] = turned.sum()
        turned *= onward  # far quicker than an exponential for each frequency
    return np.asarray(2.0 * np.abs(sums) ** 2 / times.size / max(float(np.var(rest)), 1e-30))
