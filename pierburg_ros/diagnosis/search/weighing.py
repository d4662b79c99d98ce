"""What speaks for each quantity of an explanation, beside what remains, and which of them may stay."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.diagnosis.search.moved import moved
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, scored, settled, strange, unseen
from pierburg_ros.diagnosis.search.selection import SIGNIFICANT
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Quantity, Variant, jumps, moments, quantities, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.estimation.refinement import lowered
from pierburg_ros.plant import Model

CONFIRMED = 0.5
"""Share of the gain of a quantity, from the samples that train to as many that validate, that these must show as well.
Derived: halfway between what fits the training samples alone, none of it, and what is there, all of it."""
EXPLAINS = 0.55
"""Share of the mean square, of what a quantity moves and of what remains, that it must move (`moved.py`). Measured: in
n = 61 trials, beside a remainder, of that alone or of what is outside the catalogue, 24 of the 29 right names that
carry their part and are confirmed reach 0.65 or more, in explanations on the way 0.55, the other five 0.4 or less; six
of 20 wrong ones stay below."""
CARRIES = 1.0 / 3.0
"""Share of the evidence against the model without any effect that one carries at least. Measured: in the same n = 61
trials 31 of 34 right names that are confirmed reach 0.34 or more, and 45 of 61 wrong ones stay below a third."""
ALONE = 0.8
"""Confidence of a name beside a remainder that nothing else comes near. Measured: Laplace's rule of succession, since
of effects put into real recordings all of n = 3 such names were right. With one to three rivals three of six were:
about the share of one among equals."""


@dataclass(frozen=True)
class Weight:
    """What speaks for a quantity, in -2 log likelihood: what leaving it out costs, `gain`, and what is `left` with it.

    Left is how much less likely the residual is than white noise of the sensor's size. `unseen` is what leaving it out
    costs on samples that validate, None where they were asked otherwise; of a quantity that is there as much as they
    are `expected` to show: its gain by their number over that of those that train. `explains` is the share of the mean
    square that it moves, beside what remains, None where that was not asked; `plausible`: its values are such as 95 of
    100 actuators have. `instead` is what gains almost as much in its place: an effect, or one or two drifting
    parameters. `by_rule` is the share of what a controller's rule leaves that goes with it, None where no controller
    vouches for it (`witness.py`). `bare` is what is left where none of several effects acts and what drifts stays as it
    is, 0 where it is the only one.
    """

    gain: float
    left: float
    unseen: float | None = None
    expected: float = 0.0
    explains: float | None = None
    plausible: bool = True
    instead: tuple[tuple[str, ...], ...] = ()
    by_rule: float | None = None
    bare: float = 0.0

    @property
    def carried(self) -> float:
        """Share of the evidence against the model without any effect, or without this quantity: 0 to 1."""
        gain, left = max(self.gain, 0.0), max(self.left, 0.0)
        return gain / max(gain + left, self.bare, 1e-9)

    @property
    def confirmed(self) -> bool:
        """Whether samples that no fit has seen say the same."""
        return self.unseen is None or self.unseen >= CONFIRMED * self.expected

    @property
    def believed(self) -> bool:
        """Whether it explains enough with values that an actuator has, and unseen samples confirm it."""
        return (self.explains is None or self.explains >= EXPLAINS) and self.plausible and self.confirmed

    @property
    def confidence(self) -> float:
        """How far it is believed: of equals each is as likely as another; what was asked otherwise by its share."""
        if self.by_rule is not None:
            return self.by_rule / (1 + len(self.instead))
        return self.carried if self.unseen is None else ALONE / (1 + len(self.instead))


@dataclass(frozen=True)
class Supported:
    """An explanation with its likelihood, and the weight of each of its quantities.

    `nominal` is the model that it changes: the nominal one, on a shaft that goes round with the lesser orders of the
    torque over a turn.
    """

    nominal: Model
    scored: Scored
    weights: Mapping[Quantity, Weight]


def idle(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains too little: a later one has made it needless."""
    return weight.gain < SIGNIFICANT


def unconfirmed(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains or explains too little, or gains nothing on unseen samples, as what acts only once.

    A parameter may drift a little beside an effect; an effect has to carry its part.
    """
    if idle(quantity, weight) or not weight.believed:
        return True
    return isinstance(quantity, Variant) and (bool(moments(quantity)) or weight.carried < CARRIES)


class Weighing:
    """Weighs explanations of some recordings that change a `nominal` model, each fitted with its own discrepancy.

    What was fitted from the values of a larger explanation is fitted again only from values that are likelier as they
    are. What was reached from smaller ones is: it may have stopped in the place of what was added since.
    """

    def __init__(self, data: Data, nominal: Model, pool: Executor) -> None:
        self.data, self.nominal, self.pool = data, nominal, pool
        self._known: dict[Explanation, tuple[Scored, float]] = {}
        self._from_larger: set[Explanation] = set()
        self._searched: set[Explanation] = set()

    def settled(self, fit: Fit) -> Scored:
        """A fit with its own discrepancy, or the likeliest so far of the same explanation."""
        return self._kept(settled(self.data, self.nominal, fit))[0]

    def needed(self, reached: Scored) -> Supported:
        """What was reached without what it does not need, weighed."""
        return self.thinned(self.weighed(reached), idle)

    def heard(self, told: Supported) -> Supported:
        """What of an explanation unseen samples confirm.

        The last effect is not given up before its cost was searched for other local minima, if its events jump.
        """
        while (rest := self._rest(told, unconfirmed)) is not None:
            reached, own = told.scored, told.scored.fit.explanation
            if len(own.variants) == 1 and jumps(own) and own not in self._searched:
                self._searched.add(own)
                estimator = estimator_beside(self.data, self.nominal, reached.discrepancy)
                rest = self.settled(lowered(estimator, estimator.restated(reached.fit)))
            told = self.weighed(rest)
        return told

    def thinned(self, told: Supported, out: Callable[[Quantity, Weight], bool]) -> Supported:
        """The explanation without the quantities that are `out`: the weakest goes first, then all are weighed again."""
        while (rest := self._rest(told, out)) is not None:
            told = self.weighed(rest)
        return told

    def _rest(self, told: Supported, out: Callable[[Quantity, Weight], bool]) -> Scored | None:
        """The explanation without the weakest of the quantities that are `out`, None where none is.

        What cannot be left out, since the others make no model without it, stays.
        """
        leaving = {quantity: each.gain for quantity, each in told.weights.items() if out(quantity, each)}
        rests = (self.lacking(told.scored, quantity) for quantity in sorted(leaving, key=lambda one: leaving[one]))
        return next((rest for rest in rests if rest.fit.explanation != told.scored.fit.explanation), None)

    def weighed(self, reached: Scored) -> Supported:
        """The weight of each quantity: what the others, fitted again with their own discrepancy, leave without it."""
        best, validation = self._kept(reached)
        explanation, odd = best.fit.explanation, strange(best.fit, self.data, self.nominal)
        several = len(explanation.variants) > 1
        bare = self._without(best, *explanation.variants).left if several else 0.0
        shares = moved(self.data, self.nominal, best.fit)
        expected = float(self.data.validation.sum() / self.data.train.sum())

        def weight(quantity: Quantity) -> Weight:
            rest, lost = self._lacking(best, quantity)
            own = set() if isinstance(quantity, str) else {f"{quantity.effect}.{name}" for name in quantity.free}
            gain = rest.cost - best.cost
            return Weight(
                gain,
                best.left,
                unseen=lost - validation,
                expected=expected * gain,
                explains=shares[quantity],
                plausible=not own & odd,
                bare=bare,
            )

        changes = quantities(explanation)
        return Supported(self.nominal, best, dict(zip(changes, self.pool.map(weight, changes), strict=True)))

    def lacking(self, best: Scored, *out: Quantity) -> Scored:
        """The best without some quantities, the others fitted again; itself if they cannot be left out."""
        return self._lacking(best, *out)[0]

    def _lacking(self, best: Scored, *out: Quantity) -> tuple[Scored, float]:
        try:
            begin = self._without(best, *out)
        except InputError:
            return self._kept(best)
        rest = begin.fit.explanation
        if rest not in self._from_larger or begin.cost < self._known[rest][0].cost:
            estimator = estimator_beside(self.data, self.nominal, best.discrepancy)
            found = settled(self.data, self.nominal, estimator.fit(rest, begin.fit.values, BRIEF))
            self._kept(min(begin, found, key=lambda each: each.cost))
            self._from_larger.add(rest)
        return self._known[rest]

    def _without(self, best: Scored, *out: Quantity) -> Scored:
        """The best without some quantities, the others as they are: fitted again, a drift may stand for an effect."""
        rest = functools.reduce(without, out, best.fit.explanation)
        return scored(self.data, Estimator(self.data, self.nominal).at(rest, best.fit.values))

    def _kept(self, reached: Scored) -> tuple[Scored, float]:
        """The likeliest so far of the same explanation, and what it says of samples that validate."""
        explanation = reached.fit.explanation
        known = self._known.get(explanation)
        if known is None or reached.cost < known[0].cost:
            self._known[explanation] = reached, unseen(self.data, reached.fit)
        return self._known[explanation]
