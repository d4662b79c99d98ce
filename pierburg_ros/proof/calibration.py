"""How far a confidence holds: of names given with 0.9, nine in ten should be right."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from pierburg_ros.proof.intervals import Share

EDGES = (0.0, 0.5, 0.75, 0.9, 0.99, 1.0)
"""Limits of the classes of confidence. Chosen: a doubt of one half, a quarter, a tenth, a hundredth, less."""


@dataclass(frozen=True)
class Named:
    """An effect that a diagnosis names: how sure it is, and whether the effect is there."""

    confidence: float
    right: bool


@dataclass(frozen=True)
class Class:
    """The names of a class of confidence: its limits, what was said on average, and how many are right."""

    low: float
    high: float
    said: float
    right: Share

    @property
    def holds(self) -> bool:
        """Whether what was said lies within the interval of the share that is right."""
        least, most = self.right.interval
        return least <= self.said <= most


def named(confidences: Mapping[str, float], there: Iterable[str]) -> list[Named]:
    """The names of one diagnosis, each effect with its confidence, where the effects `there` act."""
    known = set(there)
    return [Named(confidence, effect in known) for effect, confidence in confidences.items()]


def calibration(names: Sequence[Named]) -> list[Class]:
    """The classes of confidence that hold any name, the least sure first."""
    classes = []
    for low, high in itertools.pairwise(EDGES):
        of = [name for name in names if low <= name.confidence < high or (name.confidence == high == EDGES[-1])]
        if of:
            said = sum(name.confidence for name in of) / len(of)
            classes.append(Class(low, high, said, Share(sum(name.right for name in of), len(of))))
    return classes


def rows(classes: Iterable[Class]) -> list[tuple[object, ...]]:
    """The classes as rows of a table: limits, what was said, what is right, whether both agree."""
    return [
        (f"{each.low:g} to {each.high:g}", f"{each.said:.3f}", each.right, "yes" if each.holds else "no")
        for each in classes
    ]


HEAD = ("confidence", "said, mean", "right", "agrees")
"""What stands above `rows`."""
