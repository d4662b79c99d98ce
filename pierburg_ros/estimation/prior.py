"""How plausible values are before anything was recorded: what recordings leave open is not taken from far away."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED
from pierburg_ros.estimation.coordinates import Coordinates
from pierburg_ros.estimation.likelihood import SURE

KNOWN = 0.2
"""Standard deviation of the logarithm of a base parameter around its nominal value. Measured: on n = 4 splits of eight
runs of a servo, with the same two effects, the error on the runs left out is 0.116, 0.044, 0.045 and 0.072 rad at 0.5;
0.105, 0.045, 0.044 and 0.062 at 0.2; 0.098, 0.043, 0.051 and 0.065 at 0.1."""


def improbability(coordinates: Coordinates, point: Signal) -> Signal:
    """How far each quantity lies from what is plausible, in standard deviations, shape (quantities,).

    Twice the logarithm of the prior is minus the sum of their squares, but for a constant. A base parameter is known to
    `KNOWN` around its nominal value; one that is nominally 0 to its own scale. Of an effect that the actuator always
    has, it spreads around the nominal value as far as what is plausible goes. Of any other effect, a number that may
    be 0 spreads as far as its largest plausible value. One that may not, a time or a number of teeth, lies within its
    plausible range in 95 of 100 actuators, by its logarithm; a damping or a velocity that is searched so, and may be 0
    all the same, is never too small. Moments are as likely one as another.
    """
    rows = [_row(coordinates, place, float(x)) for place, x in enumerate(point)]
    return np.array(rows, dtype=np.float64)


def implausible(coordinates: Coordinates, point: Signal) -> set[str]:
    """Names of the quantities with a value that 95 of 100 actuators do not have."""
    rows = np.abs(improbability(coordinates, point))
    return {name for name, row in zip(coordinates.names, rows, strict=True) if row > SURE}


def _row(coordinates: Coordinates, place: int, x: float) -> float:
    name, axis = coordinates.names[place], coordinates.axes[place]
    if "@" in name:
        return 0.0
    own = coordinates.nominal.values[name]
    if "." not in name:
        return (x - axis.coordinate(own)) / (KNOWN if own != 0.0 else 1.0)
    if own != 0.0:
        return x - axis.coordinate(own)
    declared = DECLARED[name]
    low, high = declared.plausible
    if declared.dated:
        return 0.0
    if declared.rhythm or declared.logarithmic:
        value = max(abs(axis.value(x)) / declared.scale(coordinates.nominal.scales), 1e-300)
        far = SURE * (math.log(value) - 0.5 * math.log(low * high)) / (0.5 * math.log(high / low))
        return max(far, 0.0) if declared.default == 0.0 else far
    return x
