"""How many numbers, and how large, an input may hold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError

LARGEST = 1e9
"""Largest magnitude of a recorded value [its own unit].

No sensor, supply or angle has nine digits before its point, and squares of such values, summed over the most
samples that are read, stay 280 powers of ten below the largest double.
"""
MOST_SAMPLES = 4_000_000
"""Samples that a run may have: 2.2 h at 500 Hz. Simulated and written, each takes about 400 bytes: 1.6 of 2 GiB."""


def check_magnitude(what: str, values: NDArray[np.float64]) -> None:
    """Refuse values beyond any sensor, as they come from a wrong unit or from damage."""
    beyond = np.flatnonzero(~(np.abs(values) <= LARGEST))
    if beyond.size:
        raise InputError(
            f"{what} has {values[beyond[0]]:g} as value {beyond[0] + 1} of {values.size}, expected magnitudes up to"
            f" {LARGEST:g}. Check its unit, or cut the recording there."
        )


def check_count(duration: float, rate: float, what: str) -> None:
    """Refuse a run of `duration` [s] at `rate` [Hz] that no memory holds, before any is taken."""
    if not duration * rate <= MOST_SAMPLES:
        raise InputError(
            f"{what} of {duration:g} s at {rate:g} Hz has {duration * rate:.3g} samples, expected at most"
            f" {MOST_SAMPLES:,}. Choose a shorter duration or a lower rate."
        )
