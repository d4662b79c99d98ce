"""How far a search goes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Beam:
    """How wide, how deep and how long a search goes.

    The search grows up to `width` explanations of one size, and every single drift. An explanation has up to `depth`
    quantities, except where all parameters drift together. The `ahead` most promising of all additions are fitted
    before the others. Once `budget` candidates have been fitted, explanations no longer grow. A search that `resigns`
    fits no others if neither the most promising additions nor the most likely explanation beside a remainder is
    adequate. Where the best fit may have stopped too early, it still grows every single drift.
    """

    width: int = 3
    depth: int = 3
    ahead: int = 24
    budget: int = 1500
    resigns: bool = False
