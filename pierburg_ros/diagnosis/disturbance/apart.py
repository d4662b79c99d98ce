"""Where no explanation accounts for all: whether one does once a disturbance of the recording is set apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.disturbance.slow import ZERO, Slow, Supply, Zero
from pierburg_ros.diagnosis.disturbance.wandered import wandered
from pierburg_ros.diagnosis.disturbance.window import confined
from pierburg_ros.diagnosis.search.found import Found, search
from pierburg_ros.diagnosis.search.search import Beam
from pierburg_ros.diagnosis.search.selection import adequate
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.estimation.data import Data, Omission, data_of, in_parts
from pierburg_ros.estimation.estimator import Estimator, Fit, forgiven
from pierburg_ros.estimation.explanation import Explanation
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
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
    fits = _promising(found)
    with workers(jobs, deadline) as pool:
        for way in (_without_stretches, _beside_slow_quantities):
            for tried, beam in way(found, fits, recording, pool, progress):
                again = search(tried, found.nominal, progress, jobs, beam, deadline)
                if adequate(again.chosen):
                    return again
    return found


def _promising(found: Found) -> list[Fit]:
    """The nominal model, the best pair, and the best single quantities, errors that are large not counting for more."""

    def cost(fit: Fit) -> float:
        return float(np.mean(np.square(forgiven(fit.solution.residual))))

    singles, pairs = (
        sorted((fit for fit in found.of_size(size) if fit.explanation.changed is None), key=cost) for size in (1, 2)
    )
    return [found.fits[Explanation()], *pairs[:1], *singles][:BESIDE]


def _without_stretches(
    found: Found, fits: Sequence[Fit], recording: Recording, pool: Executor, progress: Progress
) -> Iterator[Attempt]:
    """The recording without the one stretch that an explanation fails in, if it leaves nothing elsewhere.

    Where none does, the first of them once more, for what a single quantity explains that the stretch has hidden.
    """
    estimator, others = Estimator(found.data, found.nominal), list[Data]()
    progress("what has been tried, but for one stretch")
    told = pool.map(lambda fit: without_stretch(found.data, estimator, fit, recording), fits)
    for rest, left in filter(None, told):
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
    """A single recording without the one stretch that the nominal model fails in, if that leaves nothing elsewhere.

    None where it does, and where an actuator is simulated in stretches.
    """
    if len(recordings) > 1 or data.in_stretches:
        return None
    estimator = Estimator(data, nominal)
    told = without_stretch(data, estimator, estimator.at(Explanation()), recordings[0])
    return told[0] if told and adequate(told[1]) else None


def without_stretch(data: Data, estimator: Estimator, fit: Fit, recording: Recording) -> tuple[Data, Fit] | None:
    """The recording without the one stretch that holds nearly all errors of an explanation, None where they are spread.

    With it the explanation fitted again.
    """
    robust = estimator.fit(fit.explanation, fit.values, BRIEF, forgiving=True) if fit.explanation.size else fit
    span = confined(data, data.residual(robust.model))
    if span is None:
        return None
    omission = Omission(0, span, NOTHING)
    rest = in_parts(data_of([recording], estimator.nominal, (omission,)))
    left = Estimator(rest, estimator.nominal).fit(fit.explanation, robust.values, BRIEF)
    remark = f"{recording.name}: from {span[0]:.3g} to {span[1]:.3g} s {NOTHING}; it is left out."
    return _said(rest, data, remark, disturbed=False), left


def _said(rest: Data, before: Data, remark: str, disturbed: bool) -> Data:
    """`rest` with what was said of the data `before`, and the remark."""
    kept = tuple(each for each in before.left_out if each not in rest.left_out)
    remarks = (*before.remarks, remark)
    return replace(rest, left_out=(*rest.left_out, *kept), remarks=remarks, disturbed=disturbed, unlike=before.unlike)
