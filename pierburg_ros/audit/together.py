"""Several recordings of one actuator: one set of numbers must do for all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.balance import in_balance
from pierburg_ros.audit.explained import FARTHEST, FULL, RELUCTANCE, STEP, Explained, Fit
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.estimation.balanced import Motion, balanced
from pierburg_ros.inference.least_squares import minimise
from pierburg_ros.plant import Model

ALONE = 0.8
"""Share of the motion that its own numbers explain, from which a recording tells of them. Chosen: with less, missing
physics takes the numbers elsewhere in each recording."""
LEFT = 0.1
"""Share of the motion that common numbers leave beyond what its own leave, from which a recording is of another
actuator. Measured: of n = 4 windings hotter by 25, 50, 75 and 100 K two leave 0.04 and 0.095, two 0.2."""
TIMES = 4.0
"""So many times what its own numbers leave are added to that: what they leave is missing physics, which bends them in
each recording otherwise. Measured: n = 50 pairs of one actuator leave at most `LEFT` and half as many times."""
MOST = 5
"""Recordings that are held against the first one. Work: half a second each."""

COPPER = 0.0039
"""Rise of copper's resistance [1/K]. Given: by the metal, at 20 degC."""
HOTTEST = 135.0
"""Rise of temperature that a winding bears [K]. Given: class F of IEC 60085, 155 degC, from 20 degC."""
WINDING = "armature_resistance"
"""The number that goes with the temperature."""

Pair = tuple[Signals, Explained]


def apart(pairs: Sequence[Pair], nominal: Model) -> list[Fault]:
    """The recordings that are not of the actuator of the first one; those that tell too little are left aside."""
    if len(pairs) < 2:
        return []
    own = [(signals, by_itself(signals, found, nominal)) for signals, found in pairs]
    told = [(signals, found) for signals, found in own if found.share >= ALONE and not in_balance(signals, nominal)]
    return [fault for other in told[1 : MOST + 1] if (fault := _apart(told[0], other, nominal)) is not None]


def by_itself(signals: Signals, found: Explained, nominal: Model) -> Explained:
    """What its own numbers explain of a motion: where that is little, looked for from the balance of torques too.

    Another actuator may lie so far off that the fit from the description ends before it gets there.
    """
    if found.share >= ALONE:
        return found
    fit = Fit(signals, nominal, found.length)
    motion = Motion(signals.inputs, signals.time, signals.measured, signals.quantity)
    begin = balanced(nominal, [motion], fit.names)
    return found if begin is None else max(found, fit.best(FULL, begin), key=lambda each: each.share)


def _apart(first: Pair, other: Pair, nominal: Model) -> Fault | None:
    shares, _ = common(first, other, nominal)
    if not _lost(first, other, shares):
        return None
    values = [found.model.values for _, found in (first, other)]
    names = Fit(first[0], nominal).names
    name = max(names, key=lambda each: abs(math.log(values[1][each] / values[0][each])))
    evidence = (
        f"Its own numbers explain {100 * other[1].share:.0f} % of the motion, those of {first[0].name}"
        f" {100 * first[1].share:.0f} %; one set of numbers leaves {100 * min(1.0 - min(shares), 1.0):.0f} %. They"
        f" differ most in {name}: {values[0][name]:.3g} there, {values[1][name]:.3g} here."
    )
    what = f"of another actuator than {first[0].name}, or of one that was changed"
    evidence += _warmed(first, other, nominal)
    return Fault(other[0].name, "recording", what, evidence, "diagnose the recordings one by one")


def _lost(first: Pair, other: Pair, shares: list[float]) -> bool:
    """Whether numbers that explain these `shares` of two motions explain too little beside their own."""
    own = [found.share for _, found in (first, other)]
    lost = max(alone - together for alone, together in zip(own, shares, strict=True))
    return lost >= LEFT + TIMES * (1.0 - min(own))


def _warmed(first: Pair, other: Pair, nominal: Model) -> str:
    """What to say where the temperature of the winding alone would be a reason, too."""
    if WINDING not in Fit(first[0], nominal).names:
        return ""
    shares, factor = common(first, other, nominal, WINDING)
    rise = (max(factor, 1.0 / factor) - 1.0) / COPPER
    if rise > HOTTEST or _lost(first, other, shares):
        return ""
    return f" A winding {rise:.0f} K {'hotter' if factor > 1.0 else 'colder'} than there explains it, too."


def common(first: Pair, other: Pair, nominal: Model, but: str | None = None) -> tuple[list[float], float]:
    """Shares of the two motions that one set of numbers explains, and the factor by which one number may differ.

    It is the number `but` of the other recording, 1 where there is none.
    """
    fits = [Fit(signals, nominal, found.length) for signals, found in (first, other)]
    names = fits[0].names
    differs = np.array([[float(name == but) for name in names]] if but else np.empty((0, len(names))))

    def points(point: Signal) -> tuple[Signal, Signal]:
        same = point[: len(names)]
        return same, same + point[len(names) :] @ differs

    def cost(point: Signal) -> Signal:
        left = [fit.left(fit.model(own)) for fit, own in zip(fits, points(point), strict=True)]
        return np.concatenate([RELUCTANCE * point, *(each / math.sqrt(each.size) for each in left)])

    begins = (
        np.append(fit.point(found.model), np.zeros(len(differs)))
        for fit, (_, found) in zip(fits, (first, other), strict=True)
    )
    begin = min(begins, key=lambda point: float(np.sum(np.square(cost(point)))))
    bound = np.full(begin.size, FARTHEST)
    found = minimise(cost, np.clip(begin, -bound, bound), -bound, bound, np.full(begin.size, STEP), FULL, 1e-3)
    shares = [fit.share(fit.model(own)) for fit, own in zip(fits, points(found.point), strict=True)]
    return shares, math.exp(float(np.sum(found.point[len(names) :])))
