"""Which effect the balance of torques names, where no simulation does.

A simulation of what forgets nothing, or is driven late, is far off whatever is added to it. The balance keeps each
error where it is. So an effect is judged by what it takes of the balance's error in blocks that were not fitted
(cross-validation: Stone, Cross-validatory choice and assessment of statistical predictions, 1974).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.choice import NAMED, Choice, Name, predictor
from pierburg_ros.inference.coordinates import Coordinates, in_order
from pierburg_ros.inference.data import Data
from pierburg_ros.inference.evidence import TIED, certainty, probability, repetition
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import strongest
from pierburg_ros.inference.shortlist import SETTLING, Reading, fitted, read
from pierburg_ros.plant import Model

FOLDS = 2
"""Parts of the blocks, each predicted by a fit to the others. Chosen: halves; not varied."""


@dataclass(frozen=True)
class Judged:
    """A balance with blocks by which effects are judged; `fold` is the part of each sample, -1 of what judges last."""

    balance: Balance
    nominal: Model
    block: NDArray[np.int64]
    fold: NDArray[np.int64]

    @staticmethod
    def of(balance: Balance, nominal: Model, data: Data) -> Judged:
        """The samples of a `balance` in the blocks of `data`."""
        block, judges = [], []
        for run, motion in zip(data.runs, balance.motions, strict=True):
            place = np.clip(np.searchsorted(run.time, motion.time), 0, run.time.size - 1)
            block.append(run.block[place])
            judges.append(data.by_run(data.test)[run.number][place])
        blocks = np.concatenate(block)
        _, order = np.unique(blocks, return_inverse=True)
        return Judged(balance, nominal, blocks, np.where(np.concatenate(judges), -1, order % FOLDS))

    def fitted(
        self, names: Sequence[str], values: Mapping[str, float], effects: Sequence[str], which: Flags
    ) -> tuple[dict[str, float], Signal]:
        """Values of `names` beside `effects` by some of the samples, and what they leave of all, shape (samples,)."""
        start = in_order(values, self.nominal)
        return fitted(self.balance, self.nominal, names, start, effects, SETTLING, which)

    def predicted(self, names: Sequence[str], values: Mapping[str, float], effects: Sequence[str]) -> Signal:
        """What is left of each sample by a fit to the other folds, shape (samples that do not judge last,)."""
        left = np.zeros(self.fold.size)
        for fold in range(FOLDS):
            other = (self.fold >= 0) & (self.fold != fold)
            own = self.fold == fold
            left[own] = self.fitted(names, values, effects, other)[1][own]
        return left[self.fold >= 0]

    def drifted(self, names: Sequence[str], own: Sequence[str], start: Mapping[str, float], effect: str) -> list[str]:
        """Those of the parameters `names` that pay for themselves beside an effect's `own` numbers (Schwarz)."""
        used, kept = self.fold >= 0, list(names)
        _, least = self.fitted([*kept, *own], start, [effect], used)
        effective = np.count_nonzero(used) / repetition(least[used])
        for name in names:
            fewer = [each for each in kept if each != name]
            held = {**start, name: self.nominal.values[name]}
            _, left = self.fitted([*fewer, *own], held, [effect], used)
            if effective * math.log(square(left[used]) / square(least[used])) < math.log(max(effective, math.e)):
                kept, least, start = fewer, left, held
        return kept


def square(residual: Signal) -> float:
    """Sum of squares; never 0."""
    return max(float(residual @ residual), 1e-300)


def named_along(
    choice: Choice, balance: Balance, candidates: Sequence[tuple[Variant, list[dict[str, float]]]]
) -> Choice:
    """The choice with the effect that the balance names, if any; itself where a simulation explains or names one.

    Judged are effects that act along the motion and at no times of their own, which could follow any physics in time. A
    number on a bound of the search makes an effect another one. Confidence and threshold are those of `choice.Name`.
    """
    if choice.explained or choice.names:
        return choice
    base = choice.estimated
    fitter, drifts = base.fitter, base.explanation.drifted
    inside, readings = read(base, balance, candidates)
    judged = Judged.of(inside, fitter.nominal, fitter.data)
    best: dict[str, Reading] = {}
    for reading in sorted(readings, key=lambda each: -each.share):
        declared = EFFECT[reading.variant.effect]
        if declared.along and not declared.mark and not bounded(reading, fitter.nominal, inside):
            best.setdefault(declared.id, reading)
    left = {"": judged.predicted(drifts, base.values, ())}
    left |= {name: judged.predicted([*drifts, *each.variant.names], each.values, [name]) for name, each in best.items()}
    undated = sorted((name for name in left if not name or not EFFECT[name].dated), key=lambda name: square(left[name]))
    named = undated[0]
    if not named:
        return choice
    rival = left[undated[1]]
    share = 1.0 - square(left[named]) / square(rival)
    sure = share * probability(certainty(rival, left[named], judged.block[judged.fold >= 0]))
    if sure < NAMED:
        return choice
    effective = left[named].size / repetition(left[named])
    alike = [name for name in best if effective * math.log(square(left[name]) / square(left[named])) <= TIED]
    reading = best[named]
    kept = judged.drifted(drifts, reading.variant.names, reading.values, named)
    start = {**reading.values, **{name: fitter.nominal.values[name] for name in drifts if name not in kept}}
    values, _ = judged.fitted([*kept, *reading.variant.names], start, [named], judged.fold >= 0)
    explanation = Explanation(tuple(kept), (reading.variant,))
    found, handed = (each.fit(explanation, values, 0) for each in (strongest(fitter), fitter))
    fits = (handed, *choice.fits)
    return replace(
        choice,
        chosen=found,
        handed=handed,
        predictor=predictor(handed, fits),
        fits=fits,
        names={named: Name(sure, found, choice.chosen, share)},
        doubted={name: each for name, each in choice.doubted.items() if name != named},
        ties={named: tuple((name,) for name in sorted(alike) if name != named)} if len(alike) > 1 else {},
    )


def bounded(reading: Reading, nominal: Model, balance: Balance) -> bool:
    """Whether a number of an effect, other than 0, ends on a bound of the search."""
    names = reading.variant.names
    coordinates = Coordinates(names, nominal, balance.duration)
    point, (lower, upper) = coordinates.point(reading.values), coordinates.bounds
    given = np.array([reading.values[name] != 0.0 for name in names])
    return bool(np.any(given & ((point <= lower) | (point >= upper))))
