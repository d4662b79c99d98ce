"""What the monitor says when the mismatch is real, as data and in words."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.monitoring.explanations import SUPPLY, Explanation

DEVIATIONS_99 = 2.58
"""Standard errors to either side of an interval that holds 99 %."""
SUPPLY_SHIFT = 0.02
"""Shift of the supply's logarithm between two explanations from which on the supply is part of the second."""


@dataclass(frozen=True)
class Finding:
    """A mismatch: `kind` is drift, sensor or physics; `names` are parameters that explain it alike, or the fault."""

    kind: str
    names: tuple[str, ...]
    text: str
    start: float  # of the samples that show it [s]
    end: float  # [s]

    @property
    def same(self) -> tuple[str, tuple[str, ...]]:
        """What makes two findings one: kind and names."""
        return self.kind, tuple(sorted(self.names))


def drift(explanations: list[Explanation], known: bool, start: float, end: float) -> Finding:
    """A drift that each of `explanations`, the best first, explains alike."""
    best = explanations[0]
    texts = [_worded(each, best, known) for each in explanations]
    names = tuple(str(each.name) for each in explanations)
    return Finding("drift", names, f"drift: {' or '.join(texts)}", start, end)


def physics(best: Explanation, misfit: float, travel: float, start: float, end: float) -> Finding:
    """Movements that no parameter explains: what is left is `misfit` [rad RMS] of movements over `travel` [rad]."""
    least = "the supply alone" if best.name is None else f"{best.name} x {math.exp(best.change):.2f}"
    return Finding(
        "physics",
        (),
        f"physics suspected: with the best single change, {least}, {misfit:.2g} rad RMS stay of movements over "
        f"{travel:.2g} rad, or motion and rest ask for different values; run 'pierburg diagnose' on the recording",
        start,
        end,
    )


def _worded(each: Explanation, best: Explanation, known: bool) -> str:
    low, high = (math.exp(each.change + side * DEVIATIONS_99 * each.error) for side in (-1.0, 1.0))
    text = f"{each.name} x {math.exp(each.change):.2f}"
    if each.name == SUPPLY and not known:
        text = f"{each.name} x {math.exp(each.change + float(each.supply.mean())):.2f} (not measured)"
    elif each.name == SUPPLY:
        text += f" ({low:.2f} to {high:.2f}) of what is measured"
    else:
        text += f" ({low:.2f} to {high:.2f})"
    shift = float(each.supply.mean() - best.supply.mean())
    if abs(shift) > SUPPLY_SHIFT and each.name != SUPPLY:
        text += f" together with {SUPPLY} x {math.exp(shift):.2f}"
    return text
