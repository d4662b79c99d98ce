"""Frequencies of a torque over angle or time: peaks of its spectrum above the background, from unevenly spaced
samples."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.torque_balance import finest

FEWEST = 20
"""Least number of samples for a search of frequencies. Chosen: with fewer, each of a dozen frequencies fits them."""
OUTLYING = 4.0
"""Torque beyond which it is clipped [median of its magnitude]. Chosen: 0.7 % of white noise lies beyond; a slip is not
mistaken for a frequency."""
FINE = 4
"""Number of frequencies for each further period over the whole range of places, and of bins for each period of the
highest frequency. Derived: halfway between two frequencies the power is 0.95 of its peak, and at the highest frequency
0.9."""
NEIGHBOURS = 12
"""Distance within which frequencies count as neighbours on either side, in periods over the whole range of places.
Chosen: 96 values give the background of the spectrum to 15 %; not varied."""


def rhythms(place: Signal, torque: Signal, between: tuple[float, float], most: int) -> list[float]:
    """The strongest and the clearest frequencies [1 / unit of place] of `torque` at uneven `place`, at most `most`.

    They lie `between` two limits, above one period over the whole range and below the highest that the samples resolve.
    The missing torque also wanders, more so at lower frequencies. So the search takes one frequency by its power, the
    next by how far it stands out from its neighbours, and so on. It subtracts each before it looks for the next (as in
    Hogbom's CLEAN, Astron. Astrophys. Suppl. 15, 1974): in unevenly spaced samples a frequency also appears at others.
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
    """Spacing of the frequencies that are tried [1 / unit of place]."""
    return 1.0 / (FINE * float(np.ptp(place)))


def clipped(torque: Signal) -> Signal:
    """`torque` minus its median, clipped at `OUTLYING`."""
    centred = torque - np.median(torque)
    limit = OUTLYING * float(np.median(np.abs(centred)))
    return np.asarray(np.clip(centred, -limit, limit))


def waves(place: Signal, torque: Signal, frequencies: list[float]) -> Signal:
    """The mean and the sines of some `frequencies` [1 / unit of place] that fit `torque` best, shape (samples,)."""
    turned = 2.0 * math.pi * np.outer(place, frequencies)
    known = np.concatenate([np.ones((place.size, 1)), np.cos(turned), np.sin(turned)], axis=1)
    return np.asarray(known @ np.linalg.lstsq(known, torque, rcond=None)[0])


def _frequencies(place: Signal, lowest: float, highest: float) -> Signal:
    if place.size < FEWEST or np.ptp(place) == 0.0:
        return np.empty(0)
    return np.arange(max(lowest, 1.0 / float(np.ptp(place))), min(highest, finest(place)), spacing(place))


def _power(place: Signal, torque: Signal, frequencies: Signal) -> Signal:
    """Power of the mean of `torque` in bins of place, at each of the `frequencies`, which are evenly spaced."""
    width = 1.0 / (FINE * float(frequencies[-1] + spacing(place)))
    bins = np.floor((place - np.min(place)) / width).astype(int)
    count = np.bincount(bins)
    mean = np.bincount(bins, weights=torque) / np.maximum(count, 1)
    size = round(1.0 / (spacing(place) * width))
    spectrum = np.square(np.abs(np.fft.rfft(mean, max(size, mean.size))))
    step = 1.0 / (max(size, mean.size) * width)
    return np.asarray(np.interp(frequencies, step * np.arange(spectrum.size), spectrum))


def _beside(power: Signal) -> Signal:
    """The usual power near each frequency: the mean of a spectrum whose median is that of the neighbours."""
    from scipy.ndimage import median_filter  # takes long to load

    width = min(2 * NEIGHBOURS * FINE + 1, power.size)
    return np.asarray(median_filter(power, width, mode="nearest")) / math.log(2.0) + 1e-300
