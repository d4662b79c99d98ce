"""Parameters as an optimiser sees them: of order one, relative where that makes sense, within range."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Vector
from pierburg_ros.effects import DECLARED
from pierburg_ros.effects.effect import HIGHEST_SHARE
from pierburg_ros.plant import Model

ABOVE = {name: parameter.above for name, parameter in DECLARED.items() if parameter.above is not None}
"""Parameters that are counted from another one."""
WIDEST_FACTOR = 20.0
"""A positive parameter is searched within this factor of its start."""


@dataclass(frozen=True)
class Scaling:
    """Maps the free parameters `names` of `base` to coordinates, shape (names,), with 0 at their start.

    A positive parameter is start exp(coordinate), so that a step is a relative change; one whose start is 0
    or negative, or whose range reaches below 0, is start + width coordinate, width a tenth of its plausible
    range. What stays above a base parameter is counted from it.
    """

    base: Model
    names: tuple[str, ...]
    relative: NDArray[np.bool_]
    width: Vector
    lower: Vector
    upper: Vector

    @staticmethod
    def of(base: Model, names: Sequence[str]) -> Scaling:
        """The scaling around the values of `base`."""
        rows = [_coordinate(base, name) for name in names]
        relative, width, lower, upper = (np.array(column) for column in zip(*rows, strict=True))
        return Scaling(base, tuple(names), relative.astype(bool), width, lower, upper)

    @property
    def start(self) -> Vector:
        """What the coordinates scale at their start: the values in `base`, or what exceeds another one."""
        return np.array([_own_value(self.base, name) for name in self.names], dtype=float)

    def values(self, coordinates: Vector) -> Vector:
        """Parameter values at `coordinates`."""
        grown = self.start * np.exp(np.where(self.relative, coordinates, 0.0))
        values = np.where(self.relative, grown, self.start + self.width * coordinates)
        for place, name in enumerate(self.names):
            if name in ABOVE:
                base = ABOVE[name]
                values[place] += values[self.names.index(base)] if base in self.names else self.base.values[base]
        return np.asarray(values)

    def slope(self, coordinates: Vector) -> Vector:
        """Derivative of the values with respect to the coordinates, shape (names, names)."""
        step = 1e-6 * np.eye(len(self.names))
        columns = [self.values(coordinates + row) - self.values(coordinates - row) for row in step]
        return np.asarray(np.array(columns).T / 2e-6)

    def model(self, coordinates: Vector) -> Model:
        """The model at `coordinates`, moved into the ranges and below what pairs of parameters allow."""
        changes = {}
        for name, value in zip(self.names, self.values(coordinates), strict=True):
            minimum, maximum = self.base.range(name)
            changes[name] = float(min(max(value, minimum), maximum))
        return self.base.with_values(_within_pairs({**self.base.values, **changes}, changes))


def _own_value(base: Model, name: str) -> float:
    value = base.values[name]
    return max(value - base.values[ABOVE[name]], 0.0) if name in ABOVE else value


def _coordinate(base: Model, name: str) -> tuple[bool, float, float, float]:
    minimum, maximum = base.range(name)
    value = _own_value(base, name)
    if value > 0.0 and minimum >= 0.0:
        lowest, highest = max(minimum, value / WIDEST_FACTOR), min(maximum, value * WIDEST_FACTOR)
        return True, value, min(math.log(lowest / value), -1e-6), max(math.log(highest / value), 1e-6)
    width = _width(name, value, maximum - minimum)
    return False, width, min((minimum - value) / width, -1e-6), max((maximum - value) / width, 1e-6)


def _width(name: str, value: float, span: float) -> float:
    """A tenth of the plausible range of an effect's parameter, or of a base parameter's magnitude."""
    if "." in name:
        low, high = DECLARED[name].plausible
        return 0.1 * max(high - low, abs(value)) or 1e-3 * span
    return 0.1 * abs(value) or 1e-3 * span


def _within_pairs(values: dict[str, float], changes: dict[str, float]) -> dict[str, float]:
    """`changes` with what has to stay above or below a base parameter moved there."""
    for name, parameter in DECLARED.items():
        if parameter.above is not None and values[name] != 0.0 and values[name] < values[parameter.above]:
            changes[name] = values[parameter.above]
        if parameter.below is not None and values[name] != 0.0 and values[name] >= values[parameter.below]:
            changes[name] = HIGHEST_SHARE * values[parameter.below]
    return changes
