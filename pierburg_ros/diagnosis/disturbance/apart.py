"""Where no explanation accounts for all: whether one does once a disturbance of the recording is set apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.disturbance.bridge import opened
from pierburg_ros.diagnosis.disturbance.clock import other_clock
from pierburg_ros.diagnosis.disturbance.slow import ZERO, Slow, Supply, Zero
from pierburg_ros.diagnosis.disturbance.wandered import wandered
from pierburg_ros.diagnosis.disturbance.window import confined
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.found import Found, search
from pierburg_ros.diagnosis.search.selection import adequate
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.data import Data, Omission, data_of, in_parts
from pierburg_ros.estimation.estimator import Estimator, Fit, forgiven
from pierburg_ros.estimation.explanation import Explanation, Variant, moments, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span
from pierburg_ros.workers import workers

BESIDE = 4
"""Explanations beside which disturbances are tried, the nominal model being one. Work: each costs some hundred
simulations; the right one of plain effects was among the first two."""
CONFIRMED = 1.5
"""Error over noise that a wander may leave on samples that validate. Chosen: the true one left 1.01, 1.01 and, where a
slip comes at another moment, 1.23; others, and those beside which physics was missing, 3.9 or more (about eleven)."""
Attempt = tuple[Data, Beam | None]
"""A recording with something set apart, and how far to search in it; None as far as always."""
NOTHING = "nothing that acts elsewhere explains this stretch"
"""Why a stretch is left out."""


def apart(found: Found, recording: Recording, progress: Progress, jobs: int | None, deadline: Deadline) -> Found:
    """What is found once a disturbance is set apart that leaves nothing else; `found` itself where none does.

    Physics comes first: it is asked only after a search that left something. `recording` is the one it was made on.
    Simulated in stretches that each begin anew, an actuator forgets a disturbance by itself, and none is told.
    """
    if found.data.in_stretches:
        return found
    with workers(jobs, deadline) as pool:
        fits = _promising(found, pool)
        for way in (_by_another_clock, _without_stretches, _beside_slow_quantities):
            for tried, beam in way(found, fits, recording, pool, progress):
                again = search(tried, found.nominal, progress, jobs, beam, deadline)
                if adequate(again.chosen):
                    return again
    return found


def _promising(found: Found, pool: Executor) -> list[Fit]:
    """The nominal model, the best pair, and the best single quantities, all fitted so that large errors count no more.

    Otherwise what disturbs a recording bends the very fit that tells all the rest.
    """
    estimator = found.estimator

    def cost(fit: Fit) -> float:
        return float(np.mean(np.square(forgiven(fit.solution.residual))))

    def best(size: int) -> list[Fit]:
        fits = sorted((fit for fit in found.of_size(size) if fit.explanation.changed is None), key=cost)
        return sorted(pool.map(partial(_robust, estimator), fits[: 1 if size > 1 else None]), key=cost)

    return [found.fits[Explanation()], *best(2), *best(1)][:BESIDE]


def _robust(estimator: Estimator, fit: Fit) -> Fit:
    """The explanation of `fit` fitted so that large errors count no more."""
    return estimator.restated(estimator.fit(fit.explanation, fit.values, BRIEF, forgiving=True))


def _by_another_clock(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording with its input moved to when it acted, if that is all that an explanation lacks."""
    estimator = found.estimator
    progress(f"what has been tried, with the {recording.input} by another clock")
    told = pool.map(lambda fit: with_other_clock(found.data, estimator, fit, recording), fits)
    yield from ((rest, None) for rest in told if rest)


def with_other_clock(
    data: Data, estimator: Estimator, fit: Fit, recording: Recording, alone: bool = False
) -> Data | None:
    """The recording with its input moved to when it acted; None where an explanation lacks more, or it is a delay.

    `alone`: that is all that is wrong with `fit` as it is.
    """
    clock = other_clock(data, fit.model, alone)
    if clock is None:
        return None
    told = _known(data, estimator, fit, clock.known(recording), clock.remark(recording.input))
    return told[0] if told else None


def _without_stretches(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording without the one stretch that an explanation fails in, if it leaves nothing elsewhere.

    First where nothing has to be left out, for the bridge was open. Where none does, the first of them once more, for
    what a single quantity explains that the stretch has hidden.
    """
    estimator, others = Estimator(found.data, found.nominal), list[Data]()
    progress("what has been tried, but for one stretch")
    told = pool.map(lambda fit: without_stretch(found.data, estimator, fit, recording), fits)
    for rest, left in sorted(filter(None, told), key=lambda each: len(each[0].left_out)):
        if left.ratio <= EXPLAINED:
            yield rest, None
        else:
            others.append(rest)
    for rest in others[:1]:
        yield rest, Beam(depth=1)


def _beside_slow_quantities(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording as if a quantity that wandered had been measured, beside which an explanation leaves nothing."""
    data, nominal = found.data, found.nominal
    estimator, ways = Estimator(data, nominal), slow_quantities(recording, data, nominal)
    for fit in fits:
        progress(f"{fit.explanation.label}, while something wanders")
        courses = list(pool.map(partial(wandered, data, fit, estimator=estimator), ways))
        for slow, course in zip(ways, courses, strict=True):
            if course.trained <= EXPLAINED and course.validated <= CONFIRMED:
                known = slow.known(recording, course.course, course.values)
                remark = f"{recording.name}: {slow.remark(course.course, course.values)}"
                rest = _said(in_parts(data_of([known], nominal)), data, remark, disturbed=True)
                yield course.kept_apart(rest), None


def slow_quantities(recording: Recording, data: Data, nominal: Model) -> list[Slow]:
    """What may have wandered in a recording without being measured."""
    actuator = nominal.actuator
    found: list[Slow] = [Zero(actuator.unit, ZERO * data.scales.reading)]
    if actuator.drive == "voltage" and recording.supply_voltage is None:
        found.append(Supply(nominal.values["supply_voltage"], data.scales.time))
    return found


def nominal_elsewhere(data: Data, nominal: Model, recordings: Sequence[Recording]) -> Data | None:
    """A single recording without what disturbs it, if the nominal model leaves nothing then.

    Without the one stretch that it fails in, or with the bridge open there, or with the input moved to when it acted.
    None where it leaves something, and where an actuator is simulated in stretches.
    """
    if len(recordings) > 1 or data.in_stretches:
        return None
    estimator = Estimator(data, nominal)
    fit = estimator.at(Explanation())
    told = without_stretch(data, estimator, fit, recordings[0])
    if told and adequate(told[1]):
        return told[0]
    return None if adequate(fit) else with_other_clock(data, estimator, fit, recordings[0], alone=True)


def without_stretch(data: Data, estimator: Estimator, fit: Fit, recording: Recording) -> tuple[Data, Fit] | None:
    """The recording without the one stretch that holds nearly all errors of an explanation, None where they are spread.

    Or with the bridge open meanwhile, where that leaves nothing. With it the explanation fitted again; that of `fit`
    counts large errors no more.
    """
    span = confined(data, data.residual(fit.model))
    if span is None:
        return None
    if told := with_open_bridge(data, estimator, fit, recording, span):
        return told[:2]
    omission = Omission(0, span, NOTHING)
    rest = in_parts(data_of([recording], estimator.nominal, (omission,)))
    left = Estimator(rest, estimator.nominal).fit(fit.explanation, fit.values, BRIEF)
    remark = f"{recording.name}: from {span[0]:.3g} to {span[1]:.3g} s {NOTHING}; it is left out."
    return _said(rest, data, remark, disturbed=False), left


def with_open_bridge(
    data: Data, estimator: Estimator, fit: Fit, recording: Recording, span: Span
) -> tuple[Data, Fit, Recording] | None:
    """The recording with the bridge open for a while, where that is all that an explanation lacks in a `span` [s].

    As evidence, with it the explanation fitted again, and as if the bridge had been logged. None where the explanation
    lacks more, or where the state of the bridge was logged.
    """
    bridge = opened(data, fit.model, span)
    if bridge is None:
        return None
    known = bridge.known(recording)
    told = _known(data, estimator, fit, known, bridge.remark)
    return (*told, known) if told else None


def _known(data: Data, estimator: Estimator, fit: Fit, known: Recording, remark: str) -> tuple[Data, Fit] | None:
    """A recording with what has disturbed it `known`, and an explanation fitted again; None where that leaves more."""
    rest = in_parts(data_of([known], estimator.nominal))
    left = Estimator(rest, estimator.nominal).fit(fit.explanation, fit.values, BRIEF)
    return (_said(rest, data, f"{known.name}: {remark}", disturbed=False), left) if adequate(left) else None


def bridge_for_load(found: Found, recordings: Sequence[Recording]) -> tuple[Data, Recording] | None:
    """A single recording with the bridge open, where that does what a load does that came and went.

    As evidence, and as if that had been logged. It has two quantities, and the load three. None where no such load was
    found or more is left.
    """
    load = next(filter(_passing, found.chosen.explanation.variants), None)
    if load is None or len(recordings) > 1 or found.data.in_stretches:
        return None
    rest, estimator, values = without(found.chosen.explanation, load), found.estimator, found.chosen.values
    start, end = (values[name] for name in moments(load))
    told = with_open_bridge(found.data, estimator, estimator.at(rest, values), recordings[0], (start, end))
    return (told[0], told[2]) if told else None


def _passing(variant: Variant) -> bool:
    """Whether an effect begins and ends, each at a moment that is searched."""
    return len(moments(variant)) == 2


def _said(rest: Data, before: Data, remark: str, disturbed: bool) -> Data:
    """`rest` with what was said of the data `before`, and the remark."""
    kept = tuple(each for each in before.left_out if each not in rest.left_out)
    remarks = (*before.remarks, remark)
    return replace(rest, left_out=(*rest.left_out, *kept), remarks=remarks, disturbed=disturbed, unlike=before.unlike)
