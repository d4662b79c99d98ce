"""How far a search goes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Beam:
    """How wide, how deep and how long a search goes.

    Up to `width` explanations of one size are grown further, besides every single drift, and explanations have up to
    `depth` quantities, unless all that may drift does. Of all additions to them, the `ahead` most promising are fitted
    before the others. Once `budget` candidates have been fitted, explanations no longer grow. Where these leave
    something, and so does what is likeliest beside a remainder, a search that `resigns` fits no others, or not for long
    where little is left.
    """

    width: int = 3
    depth: int = 3
    ahead: int = 24
    budget: int = 1500
    resigns: bool = False
