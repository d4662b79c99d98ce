"""The effects that can be named beside a remainder: by recordings left out, or by unseen samples of a single one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.remainder.around import goes_around, supported_around, vouched_around
from pierburg_ros.diagnosis.remainder.left_out import BETTER, LeftOut
from pierburg_ros.diagnosis.remainder.shared import shared_effects
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.signals import Signals
from pierburg_ros.diagnosis.search.supported import likelier, supported, told_apart, with_play
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.diagnosis.search.weighing import Supported, Weighing, Weight
from pierburg_ros.diagnosis.search.witness import Witness, witnessed
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.intervals import Estimate
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers

ADDING = 0.6
"""Share of the time left for adding effects that several recordings share, or quantities that a single one supports.
Work: the rest is for what could replace them, for intervals and for the shape of the remainder; not varied."""
WEIGHED = 1.0 / 3.0
"""Share of the time left then for weighing what the search has found together. Work: an explanation of nine quantities
took all of it (n = 1), and what samples had confirmed was not reported; not varied."""


@dataclass(frozen=True)
class Standing:
    """The model `base` that is accepted beside a remainder, None where no quantity is; `estimator` has fitted it.

    `left_out` and `weights` say why each of its effects is believed, by id: the evidence of recordings left out, or its
    weight beside the remainder. `told` are values that need no fit, with their intervals, by dotted name. `doubted` are
    the effects that are not probable enough to be named, by id.
    """

    estimator: Estimator
    base: Fit | None = None
    left_out: Mapping[str, LeftOut] = field(default_factory=dict)
    weights: Mapping[str, Weight] = field(default_factory=dict)
    told: Mapping[str, Estimate] = field(default_factory=dict)
    doubted: Mapping[str, Weight] = field(default_factory=dict)


def standing(
    found: Found,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    deadline: Deadline | None = None,
    recording: Recording | None = None,
) -> Standing:
    """The model that is accepted where no explanation accounts for all.

    An effect that repeats with every turn comes first. If the nominal model has such an effect and lacks overtones, no
    other is searched in a single recording. Otherwise several recordings support effects that each lower the error on
    recordings left out. A single one supports quantities that unseen samples confirm when the evidence is weighed
    against the remainder. An effect that a controller shows in a single `recording` is named as well.
    """
    data, estimator = found.data, found.estimator
    deadline = deadline or Deadline()
    around = supported_around(data, found.nominal)
    vouched = vouched_around(data, found.nominal) if around and data.several else None
    if data.several and vouched is None:
        fit, left_out = shared_effects(found, progress, jobs, deadline.part(ADDING))
        return Standing(estimator, estimator.restated(fit), left_out)
    stood = around
    if stood is None and not goes_around(data, found.nominal):
        stood = _stood(found, progress, jobs, deadline)
    told = recording and witnessed(Signals.of(recording, recording.time.size), found.nominal)
    stood = _vouched_for(stood, found, told) if told else stood
    if stood is None:
        return Standing(estimator)
    weights = _by_effect(stood)
    doubted = {effect: weight for effect, weight in stood.doubted.items() if effect not in weights}
    if not stood.weights:
        return Standing(estimator, doubted=doubted)
    fitted = Estimator(data, stood.nominal, discrepancy=stood.scored.discrepancy)
    base = fitted.restated(stood.scored.fit)
    if vouched is not None:
        return Standing(fitted, base, dict.fromkeys(weights, vouched))
    known = told.estimates if told and told.variant in stood.weights else {}
    return Standing(fitted, base, {}, weights, known, doubted)


def _stood(found: Found, progress: Progress, jobs: int | None, deadline: Deadline) -> Supported:
    """What unseen samples of a single recording confirm and nothing simpler can replace, and the play of its sensor.

    A play is read from the samples themselves: it needs none of the other quantities. If time ran out before the most
    likely explanation was known, the re-estimated model takes its place there.
    """
    data, nominal = found.data, found.nominal
    nearest = min((fit for fit in found.fits.values() if fit.explanation.changed is None), key=lambda fit: fit.chi2)
    with workers(jobs, deadline.part(ADDING)) as pool:
        added = found.beside or supported(data, nominal, found.fits.values(), pool, progress)
    deadline.stopped |= added.stopped
    weighed = deadline.part(WEIGHED)
    with workers(jobs, weighed) as pool:
        beside = weighed.attempt(partial(likelier, added, nearest, Weighing(data, nominal, pool)), added)
    with workers(jobs, deadline) as pool:
        named = told_apart(beside.confirmed, Weighing(data, nominal, pool), progress)
    if _doubtful(named, found) or _outdone(named, found):
        named = Supported(nominal, scored(data, found.estimator.at(Explanation())), {}, named.doubted)
    return with_play(named, found.recalibrated if added.stopped else beside.reached.fit, data, nominal)


def _outdone(stood: Supported, found: Found) -> bool:
    """Whether only parameters are reported, and validation samples support fewer of them, or more.

    Beside a discrepancy that explains all, values that the recording refutes are likely too. Three models are compared:
    the nominal one, the reported one, and the one with all parameters re-estimated. Each must lower the validation
    error of the one before by a tenth.
    """
    fit = stood.scored.fit
    if fit.explanation.variants or not fit.explanation.size:
        return False
    misfit = found.estimator.validation_misfit
    told = misfit(fit)
    return told >= BETTER**2 * misfit(found.fits[Explanation()]) or misfit(found.recalibrated) < BETTER**2 * told


def _doubtful(stood: Supported, found: Found) -> bool:
    """Whether the effects hardly improve on the recalibrated model in a simulation in stretches.

    An error there is not due to chance. It must fall by a tenth on validation samples: with the effects alone, or with
    them beside all recalibrated parameters. An effect without a free number is read from the samples themselves, and
    depends on no simulation.
    """
    if not (stood.scored.fit.explanation.names and found.data.in_stretches):
        return False
    estimator, named, known = Estimator(found.data, stood.nominal), stood.scored.fit, found.recalibrated
    most = BETTER**2 * found.estimator.validation_misfit(known)
    if estimator.validation_misfit(named) <= most:
        return False
    both = Explanation(known.explanation.drifted, named.explanation.variants)
    beside = estimator.fit(both, {**named.values, **{name: known.values[name] for name in both.drifted}})
    return estimator.validation_misfit(beside) > most


def _vouched_for(stood: Supported | None, found: Found, told: Witness) -> Supported | None:
    """The accepted model, with the effect that the controller has `told` by its input.

    For the sensor's play the controller is a second witness beside the recorded angle, and no simulation is consulted.
    The motion must not contradict an effect on the input. It must support a lag: the derivative part of a controller
    changes the rule in the same way. Parameters that adapted to the missing effect are fitted again beside it, if that
    lowers the error on validation samples by a tenth.
    """
    data, nominal = found.data, found.nominal
    before = stood or Supported(nominal, scored(data, found.estimator.at(Explanation())), {})
    own, estimator = before.scored.fit, Estimator(data, nominal)
    if told.variant.effect in own.explanation.effects:
        return stood
    grown = estimator.at(own.explanation.plus(told.variant), own.values)
    beside = scored(data, grown)
    effect = EFFECT[told.variant.effect]
    if effect.lag is not None and beside.cost >= before.scored.cost:
        return stood
    if effect.stage != "sensor" and beside.cost > before.scored.cost + SIGNIFICANT:
        return stood
    known = found.recalibrated
    refitted = estimator.fit(
        Explanation(known.explanation.drifted, grown.explanation.variants), {**known.values, **own.values}
    )
    if estimator.validation_misfit(refitted) < BETTER**2 * estimator.validation_misfit(grown):
        beside = scored(data, refitted)
    weight = Weight(
        before.scored.cost - beside.cost,
        beside.left,
        instead=tuple((name,) for name in told.as_well),
        by_rule=told.share,
    )
    return Supported(nominal, beside, {**before.weights, told.variant: weight}, before.doubted)


def _by_effect(stood: Supported) -> dict[str, Weight]:
    """The weight of each effect, by id."""
    return {key.effect: weight for key, weight in stood.weights.items() if isinstance(key, Variant)}
