"""Coordinates in which parameters are searched: of order one, logarithmic where that makes sense, within range."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import ADDED, DECLARED, EFFECT, EFFECTS, GEARED
from pierburg_ros.effects.effect import HIGHEST_SHARE
from pierburg_ros.inference.explanation import AFTER, WHEN, moments_of
from pierburg_ros.plant import Model

DRIFT = math.log(6.0)
"""A base parameter is searched within this factor (logarithm) of its nominal value, either way. Chosen: the paper's own
change of R is a factor of 1.42, and no fit should reach a bound; not varied."""
BROAD = 20.0
"""An effect's parameter is searched up to so many times its plausible value. Chosen: a bound that no fit should reach;
not varied."""
DECADE = 10.0
"""Factor by which the range of a logarithmic parameter exceeds the plausible range. Chosen: a bound that no fit should
reach; not varied."""
UNKNOWN = 0.04
"""Scale of a base parameter that is nominally 0, as a share of that of its unit. Chosen: a seventh of the valve's own
preload; not varied."""
ABOVE = {name: p.above for name, p in DECLARED.items() if p.above is not None}
"""Parameters that are counted from a base parameter, by dotted name."""
BELOW = {name: p.below for name, p in DECLARED.items() if p.below is not None}
"""Parameters that stay below a base parameter, by dotted name."""

STARTS, ENDS = (
    frozenset(f"{effect.id}.{moments[place]}" for effect in EFFECTS if (moments := moments_of(effect.id)))
    for place in range(2)
)
"""Moments at which an effect begins, and ends, by dotted name; an end of 0, never, is that of the recording."""


@dataclass(frozen=True)
class Axis:
    """One axis of the search: value = scale coordinate, or scale exp(coordinate) where logarithmic.

    `lower` and `upper` bound the coordinate, `minimum` and `maximum` the value; `step` is that of finite differences.
    """

    scale: float
    logarithmic: bool
    lower: float
    upper: float
    minimum: float
    maximum: float
    step: float

    def value(self, coordinate: float) -> float:
        """The value at a coordinate."""
        # an end of a wide interval may lie where exponentials are no numbers any more
        value = self.scale * (math.exp(min(coordinate, 700.0)) if self.logarithmic else coordinate)
        return min(max(value, self.minimum), self.maximum)

    def coordinate(self, value: float) -> float:
        """The coordinate of a value."""
        if self.logarithmic:
            return math.log(max(value, 1e-9 * self.scale) / self.scale)
        return value / self.scale


class Coordinates:
    """Conversion between values by dotted name and the coordinates of the search, one for each of `names`.

    A positive base parameter is searched by the logarithm of its ratio to the `nominal` one. An effect's parameter is
    searched as it declares, a moment as a share of the `duration` [s].
    """

    def __init__(self, names: tuple[str, ...], nominal: Model, duration: float) -> None:
        self.names = names
        self.nominal = nominal
        self.axes = tuple(_axis(name, nominal, duration) for name in names)
        self.bounds = (
            np.array([axis.lower for axis in self.axes]),
            np.array([axis.upper for axis in self.axes]),
        )
        self.steps = np.array([axis.step for axis in self.axes])

    def values(self, point: Signal) -> dict[str, float]:
        """Values by dotted name at `point`."""
        result = {name: axis.value(float(x)) for name, axis, x in zip(self.names, self.axes, point, strict=True)}
        for name, below in ABOVE.items():
            if name in result:
                highest = self.axes[self.names.index(name)].maximum
                result[name] = min(result[name] + result.get(below, self.nominal.values[below]), highest)
        for name in result.keys() & ENDS:
            result[name] %= self.axes[self.names.index(name)].scale
        for name in result.keys() & ADDED.keys():
            result[name] = max(result[name], least_added(name, result, self.nominal))
        return result

    def point(self, values: Mapping[str, float]) -> Signal:
        """The point with these `values`, shape (names,); a missing change is one to the same value, half way."""
        result = np.empty(len(self.names))
        for i, (name, axis) in enumerate(zip(self.names, self.axes, strict=True)):
            missing = 0.5 * axis.scale if name.endswith(WHEN) else values.get(name.removesuffix(AFTER), 0.0)
            value = values.get(name, missing)
            if name in ENDS and value == 0.0:
                value = axis.scale
            if name in ABOVE:
                value -= values.get(ABOVE[name], self.nominal.values[ABOVE[name]])
            result[i] = axis.coordinate(value)
        return np.clip(result, *self.bounds)

    def within(self, values: Mapping[str, float]) -> dict[str, float]:
        """`values` with those that are searched limited to their bounds."""
        return self.values(self.point(values))


def in_order(values: Mapping[str, float], nominal: Model) -> dict[str, float]:
    """`values` with pairs that must keep an order put in order; missing values are nominal."""
    ordered = dict(values)
    for name, above in ABOVE.items():
        value, least = (ordered.get(each, nominal.values.get(each, 0.0)) for each in (name, above))
        if value != 0.0 and value < least:
            ordered[name] = least
    for name, below in BELOW.items():
        value, most = (ordered.get(each, nominal.values.get(each, 0.0)) for each in (name, below))
        if value != 0.0 and value >= most:
            ordered[name] = HIGHEST_SHARE * most
    for name, most in GEARED.items():
        ratio = ordered.get("gear_ratio", nominal.values.get("gear_ratio", 1.0))
        if ordered.get(name, nominal.values[name]) * ratio > most:
            ordered[name] = HIGHEST_SHARE * most / ratio
    for name in ADDED:
        least = least_added(name, ordered, nominal)
        if ordered.get(name, nominal.values[name]) < least:
            ordered[name] = least
    return ordered


def least_added(name: str, values: Mapping[str, float], nominal: Model) -> float:
    """The smallest value of a parameter that may at most cancel what it is added to; missing `values` are nominal."""
    return 0.0 - values.get(ADDED[name], nominal.values[ADDED[name]])


def without_effects(model: Model, effects: Iterable[str]) -> Model:
    """`model` with these effects absent, all else unchanged except pairs that must keep an order."""
    absent = {f"{effect}.{name}": 0.0 for effect in effects for name in EFFECT[effect].names}
    return model.with_values(in_order({**model.values, **absent}, model))


def _axis(name: str, nominal: Model, duration: float) -> Axis:
    if name.endswith(WHEN):
        return Axis(duration, False, 0.03, 0.97, 0.0, duration, 0.0005)
    name = name.removesuffix(AFTER)
    return _axis_of_effect(name, nominal, duration) if "." in name else _axis_of_base(name, nominal)


def _axis_of_base(name: str, nominal: Model) -> Axis:
    minimum, maximum = nominal.range(name)
    value = nominal.values[name]
    if value > 0.0 and minimum >= 0.0:
        lower = max(-DRIFT, math.log(max(minimum / value, 1e-12)))
        return Axis(value, True, lower, min(DRIFT, math.log(maximum / value)), minimum, maximum, 0.0005)
    scale = abs(value) or UNKNOWN * nominal.scales.of_unit(nominal.actuator.parameters[name].unit)
    return Axis(scale, False, minimum / scale, maximum / scale, minimum, maximum, 0.0005)


def _axis_of_effect(name: str, nominal: Model, duration: float) -> Axis:
    p = DECLARED[name]
    if p.moment:
        return Axis(duration, False, 0.0, 1.0, p.minimum, p.maximum, 0.001)
    scale, (low, high) = p.scale(nominal.scales), p.plausible
    lowest, highest = p.searched or (-math.inf, math.inf)
    lowest, highest = max(lowest, p.minimum / scale), min(highest, p.maximum / scale)
    # if the actuator always has the effect, its drift is searched too
    own = abs(nominal.values[name]) / scale
    if p.logarithmic:
        lower, upper = math.log(max(lowest, low / DECADE)), math.log(min(highest, high * DECADE))
        if own > 0.0:
            lower, upper = min(lower, math.log(own) - DRIFT), max(upper, math.log(own) + DRIFT)
        return Axis(scale, True, lower, upper, p.minimum, p.maximum, 0.001)
    large = max(abs(low), abs(high))
    lower, upper = max(lowest / large, -BROAD), max(min(highest / large, BROAD), own * math.exp(DRIFT) / large)
    return Axis(scale * large, False, lower, upper, p.minimum, p.maximum, 0.0002 if p.rhythm else 0.001)
