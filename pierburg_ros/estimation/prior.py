"""The prior of the values: what recordings do not determine stays plausible."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED
from pierburg_ros.estimation.likelihood import SURE
from pierburg_ros.inference.coordinates import Coordinates

KNOWN = 0.2
"""Standard deviation of the logarithm of a base parameter around its nominal value. Measured: n = 4 splits of eight
runs of a servo, with the same two effects. The error on the runs left out is 0.116, 0.044, 0.045 and 0.072 rad at 0.5.
It is 0.105, 0.045, 0.044 and 0.062 at 0.2, and 0.098, 0.043, 0.051 and 0.065 at 0.1."""


def improbability(coordinates: Coordinates, point: Signal) -> Signal:
    """Distance of each quantity from plausible values, in standard deviations, shape (quantities,).

    Twice the logarithm of the prior is minus the sum of the squared distances, up to a constant. A base parameter is
    known to `KNOWN` around its nominal value, or to its own scale if it is nominally 0. A parameter of an effect that
    the actuator always has spreads around its nominal value as far as the plausible range. For any other effect, a
    number that may be 0 spreads as far as its largest plausible value. A number that may not be 0, such as a time or a
    number of teeth, lies within its plausible range in 95 of 100 actuators, by its logarithm. A damping or a velocity
    that is searched by its logarithm, but may be 0, is never too small. All moments are equally likely.
    """
    rows = [_row(coordinates, place, float(x)) for place, x in enumerate(point)]
    return np.array(rows, dtype=np.float64)


def implausible(coordinates: Coordinates, point: Signal) -> set[str]:
    """Names of the quantities whose values lie outside the range that holds 95 of 100 actuators."""
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
