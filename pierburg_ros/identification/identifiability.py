"""Which parameters a recording determines, and in words why it does not determine the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from pierburg_ros.actuators.gauge import scaling
from pierburg_ros.arrays import Signal
from pierburg_ros.identification.fit import Identified
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.intervals import slopes_at
from pierburg_ros.plant import Model
from pierburg_ros.recording.recording import Recording

HALF_INTERVAL = 1.96
"""Standard deviations in half of a 95 % interval. Derived: of a normal distribution."""
KNOWN = 0.1
"""A parameter counts as identifiable when its 95 % half-width is below this share of it. Given: a convention of the
report, a tenth."""
NOTHING = 1e-11
"""Share of a parameter's trace that counts as none. Derived: a hundred thousand roundings of 1.1e-16."""
MOST_PARTNERS = 4
"""Largest number of parameters that are tested together as an imitation of another. Work: all combinations are tried;
the valve's motion has four numbers, so four imitate any."""

ONLY_RATIOS = "not identifiable: held, since a recorded input and a motion tell all torques only in ratio to it."
"""The reason given for a factor of the input."""


@dataclass(frozen=True)
class Finding:
    """The result for one parameter while those that are free adapt to any change of it.

    `half_width` is its 95 % half-width, relative to its value; None where it is infinite. `imitation`: the percent
    change of others that equals +1 % of it.
    """

    identifiable: bool
    half_width: float | None
    imitation: dict[str, float]
    reason: str


def identifiability(fitted: Identified, recordings: Sequence[Recording]) -> dict[str, Finding]:
    """A finding for every base parameter of the actuator, free or held, and every other free parameter."""
    actuator = fitted.model.actuator
    names = tuple(dict.fromkeys([*actuator.parameters, *fitted.names]))
    unit = actuator.shown(recordings[0].unit)
    trace = _Trace(names, fitted.names, _relative_slopes(fitted, names), fitted.noise, unit)
    findings = {name: trace.finding(name) for name in names}
    gauges = (name for name in scaling(actuator) if name not in fitted.names and findings[name].identifiable)
    return findings | {name: Finding(False, None, {}, ONLY_RATIOS) for name in gauges}


def endless(fitted: Identified, model: Model, name: str, unit: str) -> Finding:
    """The finding for a parameter of `model` that a fit drives to the end of every range."""
    kept, nominal = fitted.model.values[name], model.values[name]
    if name not in fitted.names:
        why = f"not identifiable: a fit drives it to the end of its range, and does as well with {kept:.4g}"
        return Finding(False, None, {}, f"{why} {unit} as described.")
    side = "above" if kept > nominal else "below"
    why = (
        f"not identifiable: the fit drives it {side} {kept:.4g} {unit}, from {nominal:.4g} as described. Either the"
        " description is far off, or it stands for physics that the model lacks."
    )
    return Finding(False, None, {}, why)


def _relative_slopes(fitted: Identified, names: tuple[str, ...]) -> Signal:
    """Change of the residual [measured unit] per relative change of each parameter, shape (samples, names)."""
    explanation = Explanation(names)
    there = replace(fitted.fitter, nominal=fitted.model).fit(Explanation(), fitted.model.values, 0)
    coordinates = there.fitter.coordinates(explanation)
    point = coordinates.point(fitted.model.values)
    relative = [
        1.0 if axis.logarithmic or x == 0.0 else abs(x) for axis, x in zip(coordinates.axes, point, strict=True)
    ]
    return np.asarray(slopes_at(there, explanation) * np.array(relative) * fitted.unit)


@dataclass(frozen=True)
class _Trace:
    names: tuple[str, ...]
    free: tuple[str, ...]
    jacobian: Signal
    noise: float
    unit: str

    def finding(self, name: str) -> Finding:
        own = self.jacobian[:, self.names.index(name)]
        others = [other for other in self.free if other != name]
        left, _ = self._left_over(own, others)
        alone = float(np.linalg.norm(own))
        width = HALF_INTERVAL * self.noise / left if left > NOTHING * alone else None
        if width is not None and width < KNOWN:
            return Finding(True, width, {}, f"known to {_percent(width)} (95 %).")
        if HALF_INTERVAL * self.noise > KNOWN * alone:
            return Finding(False, width, {}, self._no_trace(own))
        partners, changes = self._imitation(own, others)
        imitation = dict(zip(partners, changes, strict=True))
        return Finding(False, width, imitation, self._tie(name, own, imitation))

    def _left_over(self, own: Signal, partners: Sequence[str]) -> tuple[float, Signal]:
        """Length of the part of `own` that `partners` cannot imitate, and their changes that imitate the rest."""
        if not partners:
            return float(np.linalg.norm(own)), np.empty(0)
        columns = self.jacobian[:, [self.names.index(partner) for partner in partners]]
        lengths = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
        changes = np.linalg.lstsq(columns / lengths, own, rcond=1e-6)[0] / lengths
        return float(np.linalg.norm(own - columns @ changes)), changes

    def _imitation(self, own: Signal, others: Sequence[str]) -> tuple[tuple[str, ...], Signal]:
        """The fewest parameters that imitate `own` to below the noise, and their changes."""
        for size in range(1, min(MOST_PARTNERS, len(others)) + 1):
            tried = [(*self._left_over(own, group), group) for group in combinations(others, size)]
            left, changes, group = min(tried, key=lambda row: row[0])
            if HALF_INTERVAL * self.noise > KNOWN * left:
                return group, changes
        return tuple(others), self._left_over(own, others)[1]

    def _no_trace(self, own: Signal) -> str:
        change = 0.1 * np.linalg.norm(own) / np.sqrt(own.size)
        return (
            f"leaves no trace: 10 % more of it changes the signal by {change:.2g} {self.unit} rms, "
            f"under a residual of {self.noise:.2g} {self.unit}."
        )

    def _tie(self, name: str, own: Signal, imitation: dict[str, float]) -> str:
        left, _ = self._left_over(own, tuple(imitation))
        partners = " with ".join(f"{other} {change:+.2f} %" for other, change in imitation.items())
        return (
            f"tied: +1 % of it looks like {partners}; the two differ by "
            f"{0.01 * left / np.sqrt(own.size):.1g} {self.unit} rms, "
            f"under a residual of {self.noise:.2g} {self.unit}."
        )


def _percent(share: float) -> str:
    return f"+-{100.0 * share:.2g} %"
