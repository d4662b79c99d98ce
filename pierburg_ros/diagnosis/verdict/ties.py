"""What the data cannot distinguish: other explanations that fit as well as the chosen one."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.selection import tied
from pierburg_ros.estimation.explanation import Quantity, Variant, quantities


@dataclass(frozen=True)
class Alternative:
    """What may replace one quantity of the chosen explanation, at equal fit."""

    quantity: Quantity
    instead: tuple[str, ...]


def alternatives(found: Found) -> list[Alternative]:
    """What may replace each quantity of the chosen explanation: one other, or two parameters for an effect."""
    own = set(quantities(found.chosen.explanation))
    alternatives = []
    for fit in tied(found.chosen, found.fits.values(), found.estimator):
        other = set(quantities(fit.explanation))
        lacking, added = own - other, other - own
        if len(lacking) != 1 or len(added) > 2:
            continue
        quantity = next(iter(lacking))
        if len(added) == 2 and (isinstance(quantity, str) or any(isinstance(a, Variant) for a in added)):
            continue
        names = tuple(sorted(item if isinstance(item, str) else item.effect for item in added))
        same_effect = isinstance(quantity, Variant) and names == (quantity.effect,)
        if not same_effect and Alternative(quantity, names) not in alternatives:
            alternatives.append(Alternative(quantity, names))
    return alternatives
