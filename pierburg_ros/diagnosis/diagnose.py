"""From recordings to a diagnosis: the whole path."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Literal

from pierburg_ros.audit import audit
from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.cleaning.cleaned import cleaned, said_of
from pierburg_ros.diagnosis.disturbance.apart import apart, bridge_for_load, nominal_elsewhere
from pierburg_ros.diagnosis.disturbance.rounding import rounded
from pierburg_ros.diagnosis.disturbance.touched import untouched
from pierburg_ros.diagnosis.evidence.quality import refuse_unusable
from pierburg_ros.diagnosis.limits.limits import limits
from pierburg_ros.diagnosis.limits.marks import marks
from pierburg_ros.diagnosis.remainder.around import goes_around
from pierburg_ros.diagnosis.remainder.left_out import BETTER
from pierburg_ros.diagnosis.remainder.remainder import Remainder, remainder, unexamined, unnamed
from pierburg_ros.diagnosis.remainder.standing import Standing, standing
from pierburg_ros.diagnosis.report.exhibits import exhibits
from pierburg_ros.diagnosis.report.findings import document, signals
from pierburg_ros.diagnosis.report.refusal import refusal
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.forms import other_forms
from pierburg_ros.diagnosis.search.found import Found, search, settled_on
from pierburg_ros.diagnosis.search.supported import confirmed_beside
from pierburg_ros.diagnosis.search.tried import Progress, staged
from pierburg_ros.diagnosis.search.weighing import Weighing
from pierburg_ros.diagnosis.simulation import reproduction
from pierburg_ros.diagnosis.verdict.conclusion import conclude, verdict_on
from pierburg_ros.diagnosis.verdict.shares import Shares, shares
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data, data_of, in_parts, rms
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import pace, workers

APART = 0.5
"""Share of the time left after effects have been named that the search for disturbances may take. Work: the rest is for
the shape of the remainder, and for limits; not varied."""

TRYING = 0.9
"""Share of a budget that all trials may take; the rest is for the document, its figures and files. Measured: these took
11 s after a budget of 120 s (n = 1 recording at 1 kHz); not varied."""


def diagnose(
    recordings: Sequence[Recording],
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    budget: float | None = None,
    simulation: Sequence[Recording] = (),
    force: bool = False,
) -> Result:
    """Locate, name and model what `nominal` lacks, from recordings alone, with `jobs` fits at a time (all cores).

    `progress` is given what is being tried. `jobs` is the number of fits at a time, by default one for each core. After
    `budget` [s] of an idle machine (`Deadline`), or Ctrl-C, the result is the best verdict so far, marked as such.
    Without a budget there is no time limit.
    InputError if the recordings cannot be used. If recordings of the user's own `simulation` are given, these replace
    the nominal model: `nominal` is fitted to them first. If signals are not what they are read as, only that is
    reported, unless `force` is set.
    """
    each_cleaned = [cleaned(recording, number) for number, recording in enumerate(recordings)]
    recordings = [each.recording for each in each_cleaned]
    faults = [] if force else audit(recordings, nominal)
    if faults:
        return refusal(recordings, nominal, faults)
    simulator = reproduction(simulation, recordings, nominal, progress, jobs) if simulation else None
    nominal = simulator.model if simulator else nominal
    data = said_of(each_cleaned, evidence(recordings, nominal))
    data = simulator.kept_apart(data) if simulator else data
    deadline = Deadline(None if budget is None else TRYING * budget, pace(jobs))
    look = partial(examined, nominal=nominal, progress=progress, jobs=jobs, deadline=deadline)
    found, rest = look(data, recordings=recordings)
    if opened := deadline.attempt(partial(bridge_for_load, found, recordings), None):
        again = look(opened[0], recordings=opened[1:])
        found, rest = again if verdict_on(again[0].chosen) != "unexplained" else (found, rest)
    conclusion = conclude(found, rest)
    if found.data.disturbed:
        conclusion = replace(conclusion, verdict="unexplained")
    parts = deadline.attempt(partial(shares, found, conclusion, jobs, deadline), Shares({}, None))
    excluded = limits(found, conclusion.final, progress, jobs, deadline)
    seen = marks(found, conclusion.final, jobs)
    written = document(found, conclusion, parts, excluded, seen, deadline.stopped)
    shown = signals(found.data.longest, conclusion)
    result = Result(written, conclusion.model, found.data.runs, shown, exhibits(found, conclusion))
    return simulator.told(result) if simulator else result


def examined(
    data: Data,
    nominal: Model,
    recordings: Sequence[Recording],
    progress: Progress,
    jobs: int | None,
    deadline: Deadline,
) -> tuple[Found, Remainder | None]:
    """What a search finds, a disturbance of a single recording set apart, and what can be said of the rest, if any."""
    # an effect that repeats with every turn is read from the balance of torques, not searched order by order
    turning, single = goes_around(data, nominal), len(recordings) == 1
    rest = untouched(data, nominal, recordings) or nominal_elsewhere(data, nominal, recordings)
    if rest and not turning:
        # the search for physics comes first
        found = search(data, nominal, progress, jobs, Beam(depth=1), deadline)
        if verdict_on(found.chosen) != "unexplained":
            return found, None
        data = rest
    found = search(data, nominal, progress, jobs, Beam(depth=0) if turning else None, deadline)
    if verdict_on(found.chosen) != "unexplained":
        return found, None
    if single and (doubt := rounded(found, recordings[0])):
        coarse = search(doubt.kept_apart(data), nominal, progress, jobs, None, deadline)
        if verdict_on(coarse.chosen) != "unexplained":
            return replace(coarse, data=doubt.said(coarse.data, unsettled=False)), None
        told = deadline.attempt(partial(unnamed, coarse, jobs, deadline), unexamined(coarse))
        return replace(coarse, data=doubt.said(coarse.data, unsettled=True)), told
    # effects are named first, for the names matter most if time runs short
    tell = staged(progress, "what remains")
    witness = recordings[0] if single else None
    named = deadline.attempt(partial(standing, found, tell, jobs, deadline, witness), Standing(found.estimator))
    if (explained := explains_all(named, found)) is not None:
        return settled_on(found, explained, jobs, deadline), None
    if single and not turning:
        aside, time = staged(progress, "disturbances"), deadline.part(APART)
        beside = time.attempt(partial(apart, found, recordings[0], aside, jobs, time), found)
        if verdict_on(beside.chosen) != "unexplained" and (confirmed := unseen_confirm(beside)) != "nothing":
            stand = partial(effects_stand, beside, found, aside, jobs, deadline)
            if confirmed == "all" and deadline.attempt(stand, False):
                return beside, None
            if named.base is None:
                return beside, unexamined(beside)
            found = replace(found, data=replace(found.data, remarks=beside.data.remarks))
    return found, deadline.attempt(partial(remainder, found, named, tell, jobs, deadline), unexamined(found, named))


def explains_all(named: Standing, found: Found) -> Fit | None:
    """The explanation that stands beside a remainder, fitted without one; None if it is not adequate.

    A search that was stopped may not have tried it. Other forms of its effects are tried as well: the form was chosen
    before all quantities were there.
    """
    if named.base is None:
        return None
    estimator = found.estimator
    own = estimator.fit(named.base.explanation, named.base.values)
    return next(filter(adequate, itertools.chain([own], other_forms(estimator, own))), None)


def unseen_confirm(found: Found) -> Literal["all", "the disturbance", "nothing"]:
    """How far the test samples confirm a disturbance and the explanation found beside it.

    With both, the test samples must be accounted for. Otherwise something else was mistaken for the disturbance, and
    everything is examined again without it. The explanation has to lower the error on the test samples by a tenth. The
    course of an unlogged quantity is estimated on the training samples, so little error is left there. A wrong effect
    fits there as well, and so does a parameter that is off by next to nothing.
    """
    explanation = found.chosen.explanation
    if not (found.data.disturbed and explanation.size):
        return "all"
    known = found.recalibrated if explanation.variants else found.fits[Explanation()]
    before, after = (rms(found.data.residual(fit.model, fit.switch)[found.data.test]) for fit in (known, found.final))
    if after >= EXPLAINED:
        return "nothing"
    return "all" if after < BETTER * before else "the disturbance"


def effects_stand(beside: Found, found: Found, progress: Progress, jobs: int | None, deadline: Deadline) -> bool:
    """Whether effects that are found `beside` a wander are also confirmed beside a remainder of any shape.

    A wander takes slow errors of any origin, and leaves the rest of them to effects that are not there.
    """
    fit = beside.chosen
    if not (beside.data.disturbed and fit.explanation.variants):
        return True
    begun = found.estimator.fit(fit.explanation, fit.values, BRIEF)
    with workers(jobs, deadline) as pool:
        return confirmed_beside(begun, Weighing(found.data, found.nominal, pool), progress)


def evidence(recordings: Sequence[Recording], nominal: Model) -> Data:
    """The recordings, split into training, validation and test samples; InputError if they cannot be used."""
    refuse_unusable(recordings, nominal.actuator)
    actuator = nominal.actuator
    for recording in recordings:
        if recording.quantity != actuator.quantity:
            raise InputError(
                f"{recording.name} holds {recording.quantity}, but actuator {actuator.name} measures "
                f"{actuator.quantity}. Choose the actuator that was recorded."
            )
    return in_parts(data_of(recordings, nominal))
