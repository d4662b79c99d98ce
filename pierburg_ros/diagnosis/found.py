"""What a diagnosis tells: a choice, with the model that is written, intervals, limits, shares and what remains."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.limits import Seen, seen
from pierburg_ros.diagnosis.remains import Lacking, lacking, shaped
from pierburg_ros.effects import STEP
from pierburg_ros.inference.choice import Choice
from pierburg_ros.inference.data import Data
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.inference.fit import Fit, adequate, rms_of, strongest
from pierburg_ros.inference.infer import Inferred
from pierburg_ros.inference.intervals import Interval, intervals
from pierburg_ros.inference.least_squares import FULL
from pierburg_ros.inference.search import key
from pierburg_ros.plant import Model

MISMATCH = 0.02
"""Squared error above the noise, as a share of the squared noise, below which there is none. Derived: the noise is
known to about a hundredth, its square to twice that."""


@dataclass(frozen=True)
class Share:
    """Shares, 0 to 1, of the mismatch of the model as described: what an effect takes beside the others, and alone."""

    beside: float
    alone: float


@dataclass(frozen=True)
class Shares:
    """How the mismatch of the model as described divides; None where there is none. The three add up to 1."""

    re_estimated: float | None
    effects: Mapping[str, Share]
    remains: float | None


@dataclass(frozen=True)
class Found:
    """A choice and all that is told of it.

    `written` is the fit whose model is handed out, with a map of the missing torque where that predicts better. `whole`
    are the chosen effects with all drifts free, and `lacking` what they leave of the balance;
    `lacking_of_written` is the same of `written`, but for the map. `intervals` are those of
    the chosen explanation by dotted name, and `tied_with` what may move with each quantity if all else may drift too.
    `step` is that of a converter, if it is named, in the measured unit.
    """

    inferred: Inferred
    written: Fit
    whole: Fit
    lacking: Lacking
    lacking_of_written: Lacking
    intervals: Mapping[str, Interval]
    tied_with: Mapping[str, tuple[str, ...]]
    seen: Mapping[str, Seen]
    shares: Shares
    step: float

    @property
    def choice(self) -> Choice:
        """The choice between explanations."""
        return self.inferred.choice

    @property
    def data(self) -> Data:
        """The recordings."""
        return self.written.fitter.data

    @property
    def model(self) -> Model:
        """The model that is handed out."""
        return self.written.model if self.step == 0.0 else self.written.model.with_values({STEP: self.step})

    @property
    def model_of(self) -> Literal["description", "re_estimated", "effects", "effects_and_shape"]:
        """Which model is handed out."""
        if self.written.model.residual_torque is not None:
            return "effects_and_shape"
        if self.written.explanation.variants or self.step:
            return "effects"
        return "re_estimated" if self.written.explanation.size else "description"

    def residual(self, fit: Fit) -> Signal:
        """What a fit leaves over all runs [measured unit] in a replay."""
        return fit.replayed * self.data.noise

    @cached_property
    def errors(self) -> dict[str, Signal]:
        """The same of the model as described, with parameters re-estimated, and of the one that is handed out."""
        choice = self.choice
        models = {"nominal": choice.described, "recalibrated": choice.estimated, "final": self.written}
        return {key: self.residual(fit) for key, fit in models.items()}


def found(inferred: Inferred, pool: Executor) -> Found:
    """All that is told of a choice."""
    choice = inferred.choice
    whole = with_all_drifts(inferred)
    written = choice.predictor
    of_written = lacking(written, inferred.balance)
    if not choice.explained:
        mapped = shaped(written, of_written)
        held_out = written.fitter.data.validation
        if mapped is not None and rms_of(mapped, held_out) < rms_of(written, held_out):
            written = mapped
    own = choice.handed
    held = tuple(name for name in inferred.free if name not in own.explanation.names)
    candidates = [each for each in inferred.candidates if not doubtful(choice, each[0])]
    data = own.fitter.data
    return Found(
        inferred=inferred,
        written=written,
        whole=whole,
        lacking=lacking(whole, inferred.balance),
        lacking_of_written=of_written,
        intervals=intervals(own),
        tied_with={name: each.tied_with for name, each in intervals(own, held).items()},
        seen=seen(whole, candidates, pool),
        shares=shares(choice),
        step=data.step if data.step > 1.02 * own.fitter.nominal.values[STEP] else 0.0,
    )


def doubtful(choice: Choice, variant: Variant) -> bool:
    """Whether an effect is stated elsewhere, so that no limit may exclude it: doubted, or as a tie."""
    return variant.effect in choice.doubted or variant.effect in choice.alternatives


def with_all_drifts(inferred: Inferred) -> Fit:
    """The chosen effects with all drifts free, with the pull at which they were judged."""
    choice, drifts = inferred.choice, inferred.drifts
    chosen = choice.chosen
    own = replace(chosen.explanation, drifted=tuple(name for name in drifts if name != chosen.explanation.changed))
    same = [fit for fit in choice.fits if key(fit) == key(chosen) and set(fit.explanation.drifted) == set(own.drifted)]
    start = same[0] if same else chosen
    fitter = chosen.fitter if choice.explained else strongest(chosen.fitter)
    return fitter.fit(own, start.values, FULL)


def shares(choice: Choice) -> Shares:
    """How the mismatch divides between re-estimated parameters, each effect beside the others, and what remains.

    What effects take together is divided in proportion to what is lost without each of them. A parameter that changed
    in mid-recording is a re-estimated one. Nothing is divided where the balance alone names an effect. What leaves only
    noise shows how large it is.
    """
    if any(name.along is not None for name in choice.names.values()):
        return Shares(None, {}, None)
    noise = choice.handed.ratio**2 if adequate(choice.handed) else 1.0

    def above(fit: Fit) -> float:
        """Mean square [noise^2] above the noise."""
        return max(fit.ratio**2 - noise, 0.0)

    start, estimated, left = (above(fit) for fit in (choice.described, choice.estimated, choice.handed))
    if start <= MISMATCH:
        return Shares(None, {}, None)
    # a fit of all parameters may end in a minimum above the description
    estimated = min(estimated, start)
    lost = {effect: max(above(name.rival) - above(name.fit), 0.0) for effect, name in choice.names.items()}
    whole = sum(lost.values())
    together = max(estimated - left, 0.0) / start if whole > 0.0 else 0.0
    effects = {}
    for effect, each in lost.items():
        alone = [fit for fit in choice.fits if fit.explanation.effects == (effect,)]
        least = min((above(fit) for fit in alone), default=estimated)
        beside = together * each / whole if whole > 0.0 else 0.0
        effects[effect] = Share(beside, max(estimated - least, 0.0) / start)
    remains = min(left / start, 1.0)
    return Shares(max(1.0 - together - remains, 0.0), effects, remains)
