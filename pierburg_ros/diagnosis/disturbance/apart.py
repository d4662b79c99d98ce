"""Whether an explanation accounts for the whole residual once a disturbance of the recording is taken into account."""

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
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.data import Data, Omission, data_of, in_parts
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate, forgiven
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.inference.explanation import Explanation, Variant, moments, without
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span
from pierburg_ros.workers import workers

BESIDE = 4
"""Number of explanations with which disturbances are tested; the nominal model is one. Work: each costs some hundred
simulations. For plain effects the right explanation was among the first two."""
CONFIRMED = 1.5
"""Largest error over noise on validation samples beside a wandering quantity. Chosen: the true quantity left 1.01, 1.01
and, where a slip comes at another moment, 1.23. Other quantities, and those beside which physics was missing, left 3.9
or more (about eleven)."""
Attempt = tuple[Data, Beam | None]
"""A recording with a disturbance taken into account, and how far to search in it; None is the usual depth."""
NOTHING = "nothing that acts elsewhere explains this stretch"
"""The reason for leaving out a stretch."""


def apart(found: Found, recording: Recording, progress: Progress, jobs: int | None, deadline: Deadline) -> Found:
    """The result of a search with a disturbance taken into account, if that leaves only noise; otherwise `found`
    itself.

    Physics comes first: disturbances are tested only after a search that left a remainder. `recording` is the one that
    was searched. An actuator that is simulated in stretches forgets a disturbance at each new start: none is reported
    for it.
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
    """The nominal model, the best pair and the best single quantities; in their fits large errors count by their
    logarithm.

    Otherwise a disturbance would distort the fit on which all else depends.
    """
    estimator = found.estimator

    def cost(fit: Fit) -> float:
        return float(np.mean(np.square(forgiven(fit.solution.residual))))

    def best(size: int) -> list[Fit]:
        fits = sorted((fit for fit in found.of_size(size) if fit.explanation.changed is None), key=cost)
        return sorted(pool.map(partial(_robust, estimator), fits[: 1 if size > 1 else None]), key=cost)

    return [found.fits[Explanation()], *best(2), *best(1)][:BESIDE]


def _robust(estimator: Estimator, fit: Fit) -> Fit:
    """The explanation of `fit`, fitted again with large errors counting by their logarithm."""
    return estimator.restated(estimator.fit(fit.explanation, fit.values, BRIEF, forgiving=True))


def _by_another_clock(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording with its input moved to when it acted, if an explanation lacks nothing else."""
    estimator = found.estimator
    progress(f"what has been tried, with the {recording.input} by another clock")
    told = pool.map(lambda fit: with_other_clock(found.data, estimator, fit, recording), fits)
    yield from ((rest, None) for rest in told if rest)


def with_other_clock(
    data: Data, estimator: Estimator, fit: Fit, recording: Recording, alone: bool = False
) -> Data | None:
    """The recording with its input moved to when it acted; None where an explanation lacks more, or it is a delay.

    `alone`: the clock must be the only error of `fit` as it is.
    """
    clock = other_clock(data, fit.model, alone)
    if clock is None:
        return None
    told = _known(data, estimator, fit, clock.known(recording), clock.remark(recording.input))
    return told[0] if told else None


def _without_stretches(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording without the one stretch in which an explanation fails, if that leaves only noise elsewhere.

    A recording from which nothing has to be left out, because the bridge was open, comes first. Last comes the first
    recording in which more is left: the search may find a single quantity there that the stretch has hidden.
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
    """The recording as if a wandering quantity had been measured, if an explanation with that quantity leaves only
    noise."""
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
    """The quantities that may have wandered in a recording without being measured."""
    actuator = nominal.actuator
    found: list[Slow] = [Zero(actuator.unit, ZERO * data.scales.reading)]
    if actuator.drive == "voltage" and recording.supply_voltage is None:
        found.append(Supply(nominal.values["supply_voltage"], data.scales.time))
    return found


def nominal_elsewhere(data: Data, nominal: Model, recordings: Sequence[Recording]) -> Data | None:
    """A single recording without its disturbance, if the nominal model then leaves only noise; otherwise None.

    Either the one stretch in which the model fails is left out, or the bridge is open there, or the input is moved to
    when it acted. None also for an actuator that is simulated in stretches.
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
    """The recording without the one stretch that holds nearly all errors of an explanation; None where they are spread.

    Where an open bridge in that stretch leaves only noise, the bridge is open instead. The second item is the
    explanation fitted again: in `fit`, large errors count by their logarithm.
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
    """The recording with the bridge open for a while, if an explanation lacks nothing else in a `span` [s].

    It returns the data, the explanation fitted again, and the recording as if the state of the bridge had been logged.
    None where the explanation lacks more, or where that state was logged.
    """
    bridge = opened(data, fit.model, span)
    if bridge is None:
        return None
    known = bridge.known(recording)
    told = _known(data, estimator, fit, known, bridge.remark)
    return (*told, known) if told else None


def _known(data: Data, estimator: Estimator, fit: Fit, known: Recording, remark: str) -> tuple[Data, Fit] | None:
    """The data of a recording with a `known` disturbance, and an explanation fitted again; None if more than noise is
    left."""
    rest = in_parts(data_of([known], estimator.nominal))
    left = Estimator(rest, estimator.nominal).fit(fit.explanation, fit.values, BRIEF)
    return (_said(rest, data, f"{known.name}: {remark}", disturbed=False), left) if adequate(left) else None


def bridge_for_load(found: Found, recordings: Sequence[Recording]) -> tuple[Data, Recording] | None:
    """A single recording with the bridge open, where that does the same as a load that came and went.

    It returns the data, and the recording as if the state of the bridge had been logged. An open bridge has two free
    numbers, the load three. None where no such load was found, or more than noise is left.
    """
    load = next(filter(_passing, found.chosen.explanation.variants), None)
    if load is None or len(recordings) > 1 or found.data.in_stretches:
        return None
    rest, estimator, values = without(found.chosen.explanation, load), found.estimator, found.chosen.values
    start, end = (values[name] for name in moments(load))
    told = with_open_bridge(found.data, estimator, estimator.at(rest, values), recordings[0], (start, end))
    return (told[0], told[2]) if told else None


def _passing(variant: Variant) -> bool:
    """Whether an effect begins and ends, both at moments that are fitted."""
    return len(moments(variant)) == 2


def _said(rest: Data, before: Data, remark: str, disturbed: bool) -> Data:
    """`rest` with the omissions and remarks of the data `before`, and one more remark."""
    kept = tuple(each for each in before.left_out if each not in rest.left_out)
    remarks = (*before.remarks, remark)
    return replace(rest, left_out=(*rest.left_out, *kept), remarks=remarks, disturbed=disturbed, unlike=before.unlike)
