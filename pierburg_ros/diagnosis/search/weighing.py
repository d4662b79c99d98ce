"""The evidence for each quantity of an explanation beside a remainder, and which of the quantities may stay."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field

from pierburg_ros.diagnosis.search.belief import PROBABLE, of_drift, of_effect
from pierburg_ros.diagnosis.search.moved import moved
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, scored, settled, strange, unseen
from pierburg_ros.diagnosis.search.together import needless
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.estimation.refinement import lowered
from pierburg_ros.inference.explanation import Explanation, Quantity, Variant, jumps, moments, quantities, without
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Weight:
    """Evidence for a quantity, in -2 log likelihood: `gain` is the cost of leaving it out, `left` the misfit with it.

    `left` is how much less likely the residual is than white noise of the sensor's size. `unseen` is the cost of
    leaving the quantity out on the validation samples, None if these were not evaluated in this way. `explains` is its
    share in the mean square of its own signal and the remainder, None if that was not evaluated. `plausible`: its
    values are such as 95 of 100 actuators have. `instead` is what gains almost as much in its place: an effect, or one
    or two drifting parameters. `apart` is by how much the best replacement falls short of it, as a share of its gain:
    0 if it gains as much, 1 if it gains nothing; None if no replacement was looked for. `by_rule` is the share of the
    error of a controller's rule that the quantity removes, None if no controller confirms it (`witness.py`). `bare` is
    the misfit if none of several effects acts and the drifts stay as they are, 0 unless there are several.
    """

    gain: float
    left: float
    unseen: float | None = None
    explains: float | None = None
    plausible: bool = True
    instead: tuple[tuple[str, ...], ...] = ()
    apart: float | None = None
    by_rule: float | None = None
    bare: float = 0.0

    @property
    def carried(self) -> float:
        """Share, 0 to 1, of the evidence against the model without any effect, or without this quantity."""
        gain, left = max(self.gain, 0.0), max(self.left, 0.0)
        return gain / max(gain + left, self.bare, 1e-9)

    @property
    def explained(self) -> float:
        """What it `explains`, all if that was not evaluated."""
        return 1.0 if self.explains is None else self.explains

    @property
    def confirmed(self) -> bool:
        """Whether samples that no fit has used are more likely with the quantity than without it."""
        return self.unseen is None or self.unseen > 0.0

    @property
    def confidence(self) -> float:
        """Confidence in an effect, 0 to 1: its probability, or where nothing could replace it the share it accounts
        for."""
        if self.by_rule is not None:
            return self.by_rule / (1 + len(self.instead))
        if self.explains is None or self.apart is None:
            return self.carried
        return of_effect(self.carried, self.explains, self.apart)


@dataclass(frozen=True)
class Supported:
    """An explanation with its likelihood, and the weight of each of its quantities.

    `nominal` is the model that it changes: the nominal one. For a shaft that goes round, it also has the lesser orders
    of the torque over a turn. `doubted` are effects that were left out because they are not probable, by id, with their
    weights.
    """

    nominal: Model
    scored: Scored
    weights: Mapping[Quantity, Weight]
    doubted: Mapping[str, Weight] = field(default_factory=dict)


def idle(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains too little: a later one has made it needless."""
    return weight.gain < SIGNIFICANT


def unconfirmed(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains too little, is not plausible or probable, or unseen samples do not confirm it.

    An effect that acts only once is not confirmed either. An effect counts as if nothing could replace it: what could
    is looked for later (`supported.py`).
    """
    if idle(quantity, weight) or not weight.plausible or not weight.confirmed:
        return True
    if isinstance(quantity, Variant):
        return bool(moments(quantity)) or of_effect(weight.carried, weight.explained) < PROBABLE
    return of_drift(weight.carried, weight.explained) < PROBABLE


class Weighing:
    """Weighs explanations of some recordings that change a `nominal` model, each fitted with its own discrepancy.

    An explanation fitted from the values of a larger one is fitted again only from values that are already more likely
    than that fit. An explanation reached only from smaller ones is always fitted again: it may have stopped where it
    made up for a quantity that was added since.
    """

    def __init__(self, data: Data, nominal: Model, pool: Executor) -> None:
        self.data, self.nominal, self.pool = data, nominal, pool
        self._known: dict[Explanation, tuple[Scored, float]] = {}
        self._from_larger: set[Explanation] = set()
        self._searched: set[Explanation] = set()

    def settled(self, fit: Fit) -> Scored:
        """A fit with its own discrepancy, or the most likely one so far of the same explanation."""
        return self._kept(settled(self.data, self.nominal, fit))[0]

    def needed(self, reached: Scored) -> Supported:
        """The explanation reached without the quantities that it does not need, weighed."""
        return self.thinned(self.weighed(self.lightened(reached)), idle)

    def heard(self, told: Supported) -> Supported:
        """The part of an explanation that unseen samples confirm, weighed."""
        while (out := self._weakest(told, unconfirmed)) is not None:
            told = self.given_up(told, out)
        return told

    def given_up(self, told: Supported, quantity: Quantity) -> Supported:
        """The explanation without a quantity, weighed.

        The last effect is given up only after a search for other local minima, if its cost has many.
        """
        reached, own = told.scored, told.scored.fit.explanation
        if quantity in own.variants and len(own.variants) == 1 and jumps(own) and own not in self._searched:
            self._searched.add(own)
            estimator = estimator_beside(self.data, self.nominal, reached.discrepancy)
            return self.weighed(self.settled(lowered(estimator, estimator.restated(reached.fit))))
        return self.weighed(self.lacking(reached, quantity))

    def lightened(self, reached: Scored) -> Scored:
        """`reached` without the drifts that a linear step does not need, the others fitted again; itself if that costs
        more than `SIGNIFICANT` for each of them.

        Weighing takes a fit for each quantity, and again after each that is given up.
        """
        beside = estimator_beside(self.data, self.nominal, reached.discrepancy)
        out = needless(beside.restated(reached.fit), beside, SIGNIFICANT)
        rest = self.lacking(reached, *out) if out else reached
        return rest if rest.cost - reached.cost < SIGNIFICANT * len(out) else reached

    def thinned(self, told: Supported, out: Callable[[Quantity, Weight], bool]) -> Supported:
        """The explanation without the quantities that are `out`: the weakest goes first, then all are weighed again."""
        while (weakest := self._weakest(told, out)) is not None:
            told = self.weighed(self.lacking(told.scored, weakest))
        return told

    def _weakest(self, told: Supported, out: Callable[[Quantity, Weight], bool]) -> Quantity | None:
        """The weakest of the quantities that are `out`, None if there is none.

        A quantity stays if the others make no model without it.
        """
        leaving = {quantity: each.gain for quantity, each in told.weights.items() if out(quantity, each)}
        return next((one for one in sorted(leaving, key=lambda one: leaving[one]) if self.removable(told, one)), None)

    def removable(self, told: Supported, quantity: Quantity) -> bool:
        """Whether the other quantities make a model without this one."""
        return self.lacking(told.scored, quantity).fit.explanation != told.scored.fit.explanation

    def weighed(self, reached: Scored) -> Supported:
        """The explanation with a weight for each quantity, from a fit of the others with their own discrepancy."""
        best, validation = self._kept(reached)
        explanation, odd = best.fit.explanation, strange(best.fit, self.data, self.nominal)
        several = len(explanation.variants) > 1
        bare = self._without(best, *explanation.variants).left if several else 0.0
        shares = moved(self.data, self.nominal, best.fit)

        def weight(quantity: Quantity) -> Weight:
            rest, lost = self._lacking(best, quantity)
            own = set() if isinstance(quantity, str) else {f"{quantity.effect}.{name}" for name in quantity.free}
            gain = rest.cost - best.cost
            return Weight(
                gain,
                best.left,
                unseen=lost - validation,
                explains=shares[quantity],
                plausible=not own & odd,
                bare=bare,
            )

        changes = quantities(explanation)
        return Supported(self.nominal, best, dict(zip(changes, self.pool.map(weight, changes), strict=True)))

    def lacking(self, best: Scored, *out: Quantity) -> Scored:
        """`best` without some quantities, the others fitted again; `best` itself if they cannot be left out."""
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
        """`best` without some quantities, the others unchanged: fitted again, a drift might replace an effect."""
        rest = functools.reduce(without, out, best.fit.explanation)
        return scored(self.data, Estimator(self.data, self.nominal).at(rest, best.fit.values))

    def _kept(self, reached: Scored) -> tuple[Scored, float]:
        """The most likely one so far of the same explanation, and its `unseen` cost on the validation samples."""
        explanation = reached.fit.explanation
        known = self._known.get(explanation)
        if known is None or reached.cost < known[0].cost:
            self._known[explanation] = reached, unseen(self.data, reached.fit)
        return self._known[explanation]
