"""What the data cannot distinguish: other explanations that fit as well as the chosen one."""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.selection import tied
from pierburg_ros.inference.explanation import Quantity, Variant, id_of, quantities


@dataclass(frozen=True)
class Alternative:
    """What may replace one quantity of the chosen explanation, at equal fit."""

    quantity: Quantity
    instead: tuple[str, ...]


def alternatives(found: Found) -> list[Alternative]:
    """What may replace each quantity of the chosen explanation, by the explanations that fit as well.

    Where such an explanation lacks several of the chosen quantities, all that it has instead replaces each effect among
    them. It then has as many quantities as the chosen one at most.
    """
    own = set(quantities(found.chosen.explanation))
    listed = dict[Alternative, None]()
    for fit in tied(found.chosen, found.fits.values(), found.estimator):
        other = set(quantities(fit.explanation))
        added = other - own
        names = tuple(sorted(map(id_of, added)))
        for quantity in _replaced(own - other, added):
            if isinstance(quantity, str) or quantity.effect not in names:
                listed[Alternative(quantity, names)] = None
    return list(listed)


def _replaced(lacking: set[Quantity], added: set[Quantity]) -> list[Quantity]:
    """Those of the `lacking` quantities for which the `added` ones stand.

    One quantity is replaced by one other, an effect by two drifting parameters too. Of several, the effects are
    replaced by no more quantities than there are.
    """
    single = len(lacking) == 1
    two_drifts = single and len(added) == 2 and not any(isinstance(each, Variant) for each in added)
    if len(added) > len(lacking) and not two_drifts:
        return []
    any_kind = single and not two_drifts
    return [each for each in sorted(lacking, key=id_of) if any_kind or isinstance(each, Variant)]
