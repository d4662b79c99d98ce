"""Rhythms of a torque over angle or time: its spectrum at uneven places, beside what wanders without a rhythm."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.torque_balance import finest

FEWEST = 20
"""Samples from which a rhythm is looked for. Chosen: fewer give each of a dozen frequencies what it wants."""
OUTLYING = 4.0
"""Torque [median of its magnitude] beyond which it is clipped. Chosen: of white noise 0.7 % lies beyond; a slip does
not pass for a rhythm."""
FINE = 4
"""Frequencies looked at for each period more over the whole place, and bins of place for each period of the highest.
Derived: the power half way between two of them is 0.95 of its peak, and that of the highest frequency 0.9."""
NEIGHBOURS = 12
"""Periods over the whole place by which frequencies count as neighbours, to either side. Chosen: 96 values say what a
spectrum is there without a rhythm to 15 %; not varied."""


def rhythms(place: Signal, torque: Signal, between: tuple[float, float], most: int) -> list[float]:
    """The strongest and the clearest frequencies [1 / unit of place] of `torque` at uneven `place`, at most `most`.

    They lie `between` two, above one period over the whole place and below what the samples tell. What is missing also
    wanders, the more the slower, so one counts by its power, the next by how far it stands out from the frequencies
    beside it, and so on. Each is taken away before the next is looked for (as by Hogbom's CLEAN, Astron. Astrophys.
    Suppl. 15, 1974), since at uneven places one shows at other frequencies too.
    """
    frequencies = _frequencies(place, *between)
    left = clipped(torque) if frequencies.size else torque
    found: list[float] = []
    while frequencies.size and len(found) < most:
        apart = np.ones(frequencies.size, dtype=bool)
        for other in found:
            apart &= np.abs(frequencies - other) > FINE * spacing(place)
        if not apart.any():
            break
        power = _power(place, left, frequencies)
        clear = power if len(found) % 2 == 0 else power / _beside(power)
        found.append(float(frequencies[np.argmax(np.where(apart, clear, 0.0))]))
        left = left - waves(place, left, found[-1:])
    return found


def spacing(place: Signal) -> float:
    """Distance of the frequencies that are looked at [1 / unit of place]."""
    return 1.0 / (FINE * float(np.ptp(place)))


def clipped(torque: Signal) -> Signal:
    """`torque` from its median, with what lies far out brought in."""
    centred = torque - np.median(torque)
    limit = OUTLYING * float(np.median(np.abs(centred)))
    return np.asarray(np.clip(centred, -limit, limit))


def waves(place: Signal, torque: Signal, frequencies: list[float]) -> Signal:
    """The sines of some `frequencies` [1 / unit of place] and the mean that come closest to `torque`."""
    turned = 2.0 * math.pi * np.outer(place, frequencies)
    known = np.concatenate([np.ones((place.size, 1)), np.cos(turned), np.sin(turned)], axis=1)
    return np.asarray(known @ np.linalg.lstsq(known, torque, rcond=None)[0])


def _frequencies(place: Signal, lowest: float, highest: float) -> Signal:
    if place.size < FEWEST or np.ptp(place) == 0.0:
        return np.empty(0)
    return np.arange(max(lowest, 1.0 / float(np.ptp(place))), min(highest, finest(place)), spacing(place))


def _power(place: Signal, torque: Signal, frequencies: Signal) -> Signal:
    """Power of the mean `torque` over place at each of the `frequencies`, which are evenly spaced."""
    width = 1.0 / (FINE * float(frequencies[-1] + spacing(place)))
    bins = np.floor((place - np.min(place)) / width).astype(int)
    count = np.bincount(bins)
    mean = np.bincount(bins, weights=torque) / np.maximum(count, 1)
    size = round(1.0 / (spacing(place) * width))
    spectrum = np.square(np.abs(np.fft.rfft(mean, max(size, mean.size))))
    step = 1.0 / (max(size, mean.size) * width)
    return np.asarray(np.interp(frequencies, step * np.arange(spectrum.size), spectrum))


def _beside(power: Signal) -> Signal:
    """What is usual beside each frequency: the mean of a spectrum whose median is that of the neighbours."""
    from scipy.ndimage import median_filter  # takes long to load

    width = min(2 * NEIGHBOURS * FINE + 1, power.size)
    return np.asarray(median_filter(power, width, mode="nearest")) / math.log(2.0) + 1e-300
