"""How an effect is put into a real recording of which only the channels are changed, so that it is known to be there.

That is exact where the machine that made the recording would, with the effect added to it, have made the changed one.
The functions of the effects' files state their equations again in NumPy: they share nothing with the simulator that a
diagnosis fits with.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError

Samples = NDArray[np.float64]


@dataclass(frozen=True)
class Series:
    """Values at their times [s], each of shape (samples,)."""

    time: Samples
    values: Samples


@dataclass(frozen=True)
class Channels:
    """What a recording holds and an effect may change.

    `measured` in the measured unit; `command` and `supply_voltage` [V] hold each value until the next, the latter None
    where it was not recorded. The sensor shows `zero` at the angle 0 and `per_radian` more for each rad (or rad/s);
    `span` [rad] is what it covers.
    """

    measured: Series
    command: Series
    supply_voltage: Series | None
    zero: float
    per_radian: float
    span: float


PutIn = Callable[[Channels, Mapping[str, float]], Channels]
"""The channels with an effect whose parameters have these values, by name.

CannotPutIn where that is not exact for these channels.
"""


class CannotPutIn(InputError):
    """Why an effect cannot be put into these channels exactly."""
