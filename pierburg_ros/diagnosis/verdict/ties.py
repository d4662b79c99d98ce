"""What the data cannot tell apart: other explanations that fit as well as the chosen one."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from pierburg_ros.diagnosis.search.explanation import Explanation, Quantity, Variant, canonical, quantities, without
from pierburg_ros.diagnosis.search.explore import Exploration
from pierburg_ros.diagnosis.search.fits import Fit
from pierburg_ros.diagnosis.search.selection import alike, tied


@dataclass(frozen=True)
class Alternative:
    """What may stand for one quantity of the chosen explanation, at equal fit."""

    quantity: Quantity
    instead: tuple[str, ...]


def explore_alternatives(exploration: Exploration, best: Fit) -> None:
    """Try what else could stand for each quantity of `best`: any other one, for an effect any one or two parameters."""
    limit = alike(best)
    for quantity in quantities(best.explanation):
        rest = without(best.explanation, quantity)
        exploration.sharpen(exploration.grow(rest))
        if isinstance(quantity, Variant):
            free = [name for name in exploration.drifts if name not in rest.drifted and name != rest.changed]
            for others in (*itertools.combinations(free, 1), *itertools.combinations(free, 2)):
                key = canonical(Explanation((*rest.drifted, *others), rest.variants, rest.changed), exploration.drifts)
                known = exploration.fits.get(key) if key is not None else None
                if key is not None and (known is None or known.misfit > limit):
                    exploration.consider(key, quantity, best)


def alternatives(exploration: Exploration, best: Fit) -> list[Alternative]:
    """For each quantity of `best`, what may stand for it: one other quantity, or two parameters for an effect."""
    own = set(quantities(best.explanation))
    found = []
    for fit in tied(best, exploration.fits.values(), exploration.search):
        other = set(quantities(fit.explanation))
        lacking, added = own - other, other - own
        if len(lacking) != 1 or len(added) > 2:
            continue
        quantity = next(iter(lacking))
        if len(added) == 2 and (isinstance(quantity, str) or any(isinstance(a, Variant) for a in added)):
            continue
        names = tuple(sorted(item if isinstance(item, str) else item.effect for item in added))
        same_effect = isinstance(quantity, Variant) and names == (quantity.effect,)
        if not same_effect and Alternative(quantity, names) not in found:
            found.append(Alternative(quantity, names))
    return found


def visibility(exploration: Exploration, best: Fit, variant: Variant, starts: list[dict[str, float]]) -> float:
    """The largest chi2 that `variant` at a plausible strength would leave on top of `best` after a re-fit."""
    base = exploration.search.linearised(best)
    return max((promise for promise in exploration.search.marks(base, variant, starts)), default=0.0)
