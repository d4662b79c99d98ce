"""An explanation: the quantities that it changes, and how a search moves them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED
from pierburg_ros.plant import Model

DRIFT = math.log(6.0)
"""A base parameter may drift by up to this factor (logarithm) either way."""
ABOVE = {name: p.above for name, p in DECLARED.items() if p.above is not None}
"""Parameters that a search moves by what they exceed another one."""
RHYTHMS = tuple(name for name, p in DECLARED.items() if p.rhythm)
"""Parameters that are known as finely as the recording is long, and move in small steps."""
LEAST = {name: p.least for name, p in DECLARED.items() if p.least is not None}
"""Lowest values that are looked for."""
LOGARITHMIC = frozenset(name for name, p in DECLARED.items() if p.logarithmic)
"""Parameters that are searched by their logarithm."""


@dataclass(frozen=True)
class Variant:
    """One way in which an effect may act: which of its parameters are free, and the values of the others."""

    effect: str
    free: tuple[str, ...]
    fixed: tuple[tuple[str, float], ...] = ()

    @property
    def label(self) -> str:
        """For people: the effect, and what is fixed about it."""
        fixed = ", ".join(f"{name} {value:g}" for name, value in self.fixed)
        return f"{self.effect} ({fixed})" if fixed else self.effect


AFTER = "@after"
"""Marks the value of a parameter after its change in the middle of a recording."""
WHEN = "@time"
"""Marks the time [s] of that change."""


@dataclass(frozen=True)
class Explanation:
    """Base parameters that have drifted, one that changed in the middle of the recording, and effects that act."""

    drifted: tuple[str, ...] = ()
    variants: tuple[Variant, ...] = ()
    changed: str | None = None

    @property
    def size(self) -> int:
        """How many quantities are changed: each drifted parameter and each effect counts one."""
        return len(self.drifted) + len(self.variants) + (self.changed is not None)

    @property
    def label(self) -> str:
        """For people: what it changes."""
        change = (f"change of {self.changed}",) if self.changed else ()
        return " + ".join((*self.drifted, *change, *(variant.label for variant in self.variants))) or "nominal"

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that act."""
        return tuple(variant.effect for variant in self.variants)

    @property
    def names(self) -> tuple[str, ...]:
        """Dotted names of all free quantities."""
        own = tuple(f"{v.effect}.{name}" for v in self.variants for name in v.free)
        if self.changed is None:
            return self.drifted + own
        return (*self.drifted, *own, self.changed, self.changed + AFTER, self.changed + WHEN)

    @property
    def fixed(self) -> dict[str, float]:
        """Values by dotted name that the variants fix."""
        return {f"{v.effect}.{name}": value for v in self.variants for name, value in v.fixed}

    def plus(self, variant: Variant) -> Explanation:
        """This explanation with one more effect."""
        return Explanation(self.drifted, (*self.variants, variant), self.changed)


Quantity = str | Variant
"""A drifted or changed parameter, or an effect."""


def quantities(explanation: Explanation) -> tuple[Quantity, ...]:
    """What an explanation changes, one by one."""
    changed = (explanation.changed,) if explanation.changed else ()
    return (*explanation.drifted, *changed, *explanation.variants)


def without(explanation: Explanation, quantity: Quantity) -> Explanation:
    """The explanation less one of its quantities."""
    return Explanation(
        tuple(name for name in explanation.drifted if name != quantity),
        tuple(variant for variant in explanation.variants if variant != quantity),
        None if explanation.changed == quantity else explanation.changed,
    )


def canonical(explanation: Explanation, order: Sequence[str]) -> Explanation | None:
    """The same explanation with what may drift in this `order`; None where a quantity stands twice."""
    drifted = tuple(name for name in order if name in explanation.drifted)
    effects = explanation.effects
    always = {name.split(".")[0] for name in order if "." in name}
    if len(drifted) < len(explanation.drifted) or len(set(effects)) < len(effects) or always & set(effects):
        return None
    if explanation.changed in drifted:
        return None
    variants = tuple(sorted(explanation.variants, key=lambda variant: variant.effect))
    return Explanation(drifted, variants, explanation.changed)


@dataclass(frozen=True)
class Coordinates:
    """Between dotted values and the scaled numbers a search moves; one entry a free quantity."""

    names: tuple[str, ...]
    nominal: Model
    duration: float

    def values(self, point: Signal) -> dict[str, float]:
        """Values by dotted name at `point`."""
        result: dict[str, float] = {}
        for name, x in zip(self.names, point, strict=True):
            result[name] = self._value(name, float(x))
        for name, below in ABOVE.items():
            if name in result:
                highest = self._declared(name)[1]
                result[name] = min(result[name] + result.get(below, self.nominal.values[below]), highest)
        return result

    def point(self, values: Mapping[str, float]) -> Signal:
        """The point with these `values`; a change of which they say nothing is one to the same value, half way."""
        lower, upper = self.bounds()
        result = np.empty(len(self.names))
        for i, name in enumerate(self.names):
            missing = 0.5 * self.duration if name.endswith(WHEN) else values.get(name.removesuffix(AFTER), 0.0)
            value = values.get(name, missing)
            if name in ABOVE:
                value -= values.get(ABOVE[name], self.nominal.values[ABOVE[name]])
            result[i] = self._coordinate(name, value)
        return np.clip(result, lower, upper)

    def bounds(self) -> tuple[Signal, Signal]:
        """Lowest and highest point."""
        pairs = [self._bound(name) for name in self.names]
        return np.array([low for low, _ in pairs]), np.array([high for _, high in pairs])

    def steps(self) -> Signal:
        """Finite-difference steps: of a drift 0.05 %, of an effect a thousandth of its plausible range."""
        return np.array([_step(name) for name in self.names])

    def _declared(self, name: str) -> tuple[float, float, float, float, float]:
        p = DECLARED[name]
        scale = max(abs(p.plausible[0]), abs(p.plausible[1]))
        return p.minimum, p.maximum, p.plausible[0], p.plausible[1], scale

    def _value(self, name: str, x: float) -> float:
        if name.endswith(WHEN):
            return x * self.duration
        name = name.removesuffix(AFTER)
        if "." not in name:
            return self.nominal.values[name] * math.exp(x)
        minimum, maximum, _, _, scale = self._declared(name)
        value = math.exp(x) if name in LOGARITHMIC else x * scale
        return min(max(value, minimum), maximum)

    def _coordinate(self, name: str, value: float) -> float:
        if name.endswith(WHEN):
            return value / self.duration
        name = name.removesuffix(AFTER)
        if "." not in name:
            return math.log(value / self.nominal.values[name])
        if name in LOGARITHMIC:
            return math.log(max(value, 1e-9))
        return value / self._declared(name)[4]

    def _bound(self, name: str) -> tuple[float, float]:
        if name.endswith(WHEN):
            return 0.03, 0.97
        name = name.removesuffix(AFTER)
        if "." not in name:
            p = self.nominal.actuator.parameters[name]
            low = max(-DRIFT, math.log(max(p.minimum, 1e-12) / p.nominal))
            return low, min(DRIFT, math.log(p.maximum / p.nominal))
        minimum, maximum, low, high, scale = self._declared(name)
        minimum = LEAST.get(name, minimum)
        if name in LOGARITHMIC:
            return math.log(max(minimum, low / 10.0, 1e-9)), math.log(min(maximum, high * 10.0))
        return max(minimum, -20.0 * scale) / scale, min(maximum, 20.0 * scale) / scale


def _step(name: str) -> float:
    if name.endswith(WHEN):
        return 0.0005
    if name in RHYTHMS:
        return 0.0002
    return 0.001 if "." in name else 0.0005
