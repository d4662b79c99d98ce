"""An explanation: the quantities of a nominal model that it changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pierburg_ros.effects import EFFECT


@dataclass(frozen=True)
class Variant:
    """One way in which an effect may act: its free parameters, and the values of the others."""

    effect: str
    free: tuple[str, ...]
    fixed: tuple[tuple[str, float], ...] = ()

    @property
    def label(self) -> str:
        """Label for the user: the effect, and its fixed parameters."""
        fixed = ", ".join(f"{name} {value:g}" for name, value in self.fixed)
        return f"{self.effect} ({fixed})" if fixed else self.effect


AFTER = "@after"
"""Marks the value of a parameter after its change in the middle of a recording."""
WHEN = "@time"
"""Marks the time [s] of a change in the middle of a recording."""


@dataclass(frozen=True)
class Explanation:
    """Base parameters that have drifted, one that changed in the middle of the recording, and the effects that act."""

    drifted: tuple[str, ...] = ()
    variants: tuple[Variant, ...] = ()
    changed: str | None = None

    @property
    def size(self) -> int:
        """Number of changed quantities: each drifted parameter, the changed parameter and each effect count one."""
        return len(self.drifted) + len(self.variants) + (self.changed is not None)

    @property
    def label(self) -> str:
        """Label for the user: the quantities that it changes."""
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
        """The values that the variants fix, by dotted name."""
        return {f"{v.effect}.{name}": value for v in self.variants for name, value in v.fixed}

    def plus(self, variant: Variant) -> Explanation:
        """This explanation with one more effect."""
        return Explanation(self.drifted, (*self.variants, variant), self.changed)


def jumps(explanation: Explanation) -> bool:
    """Whether events jump as the values change, so that the cost has many local minima."""
    return any(EFFECT[effect].jumps for effect in explanation.effects)


def moments(variant: Variant) -> list[str]:
    """Dotted names of the moments of an effect that are fitted, in their order."""
    declared = EFFECT[variant.effect].parameters
    return [f"{variant.effect}.{each.name}" for each in declared if each.moment and each.name in variant.free]


Quantity = str | Variant
"""A drifted or changed parameter, or an effect."""


def id_of(quantity: Quantity) -> str:
    """Name of the parameter, or id of the effect."""
    return quantity if isinstance(quantity, str) else quantity.effect


def quantities(explanation: Explanation) -> tuple[Quantity, ...]:
    """The quantities that an explanation changes."""
    changed = (explanation.changed,) if explanation.changed else ()
    return (*explanation.drifted, *changed, *explanation.variants)


def without(explanation: Explanation, quantity: Quantity) -> Explanation:
    """The explanation without one of its quantities."""
    return Explanation(
        tuple(name for name in explanation.drifted if name != quantity),
        tuple(variant for variant in explanation.variants if variant != quantity),
        None if explanation.changed == quantity else explanation.changed,
    )


def canonical(explanation: Explanation, order: Sequence[str]) -> Explanation | None:
    """The same explanation with its drifts in this `order`; None where a quantity occurs twice or may not drift."""
    drifted = tuple(name for name in order if name in explanation.drifted)
    effects = explanation.effects
    always = {name.split(".")[0] for name in order if "." in name}
    if len(drifted) < len(explanation.drifted) or len(set(effects)) < len(effects) or always & set(effects):
        return None
    if explanation.changed in drifted:
        return None
    variants = tuple(sorted(explanation.variants, key=lambda variant: variant.effect))
    return Explanation(drifted, variants, explanation.changed)
