"""An explanation: the quantities of a nominal model that it changes."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pierburg_ros.effects import EFFECT


@dataclass(frozen=True)
class Variant:
    """One way in which an effect may act: its free parameters, and the values of the others."""

    effect: str
    free: tuple[str, ...]
    fixed: tuple[tuple[str, float], ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """The dotted names of its free parameters."""
        return tuple(f"{self.effect}.{name}" for name in self.free)

    def holding(self, name: str, value: float) -> Variant:
        """The same with one of its parameters held at a value."""
        own = self.freeing(name)
        return Variant(self.effect, tuple(each for each in own.free if each != name), (*own.fixed, (name, value)))

    def freeing(self, name: str) -> Variant:
        """The same with one of its parameters free."""
        fixed = tuple(each for each in self.fixed if each[0] != name)
        return Variant(self.effect, self.free if name in self.free else (*self.free, name), fixed)


AFTER = "@after"
"""Marks the value of a parameter after its change in the middle of a recording."""
WHEN = "@time"
"""Marks the time [s] of a change in the middle of a recording."""


@dataclass(frozen=True)
class Explanation:
    """Base parameters that have drifted, one that changed in the middle of the recording, and the effects that act.

    `when` is the moment of the change [s] where it is held.
    """

    drifted: tuple[str, ...] = ()
    variants: tuple[Variant, ...] = ()
    changed: str | None = None
    when: float | None = None

    @property
    def size(self) -> int:
        """Number of changed quantities: each drifted parameter, the changed parameter and each effect count one."""
        return len(self.drifted) + len(self.variants) + (self.changed is not None)

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that act."""
        return tuple(variant.effect for variant in self.variants)

    @property
    def names(self) -> tuple[str, ...]:
        """Dotted names of all free quantities."""
        own = tuple(name for variant in self.variants for name in variant.names)
        if self.changed is None:
            return self.drifted + own
        moment = (self.changed + WHEN,) if self.when is None else ()
        return (*self.drifted, *own, self.changed, self.changed + AFTER, *moment)

    @property
    def fixed(self) -> dict[str, float]:
        """The values that are fixed, by dotted name."""
        moment = {} if self.changed is None or self.when is None else {self.changed + WHEN: self.when}
        return moment | {f"{v.effect}.{name}": value for v in self.variants for name, value in v.fixed}

    def plus(self, variant: Variant) -> Explanation:
        """This explanation with one more effect."""
        return replace(self, variants=(*self.variants, variant))

    def formed(self, variant: Variant) -> Explanation:
        """This explanation with one of its effects acting in this way."""
        own = tuple(variant if each.effect == variant.effect else each for each in self.variants)
        return replace(self, variants=own)


def jumps(explanation: Explanation) -> bool:
    """Whether an effect shows at events, which jump as the values change: the cost then has many local minima."""
    return any(EFFECT[effect].mark is not None for effect in explanation.effects)


def moments_of(effect: str) -> list[str]:
    """The first and the last moment at which an effect acts, if it is dated by any: names of parameters."""
    return [p.name for p in EFFECT[effect].parameters if p.moment]


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
