"""From recordings to a diagnosis: the whole path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from pierburg_ros.audit import audit
from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.cleaning.cleaned import cleaned, said_of
from pierburg_ros.diagnosis.disturbance.apart import apart
from pierburg_ros.diagnosis.disturbance.rounding import rounded, unnamed
from pierburg_ros.diagnosis.evidence.quality import refuse_unusable
from pierburg_ros.diagnosis.evidence.turn import has_overtones
from pierburg_ros.diagnosis.limits.limits import limits
from pierburg_ros.diagnosis.remainder.remainder import remainder, unexamined
from pierburg_ros.diagnosis.report.exhibits import exhibits
from pierburg_ros.diagnosis.report.findings import document, longest, signals
from pierburg_ros.diagnosis.report.refusal import refusal
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.search.found import Found, search
from pierburg_ros.diagnosis.search.search import Beam
from pierburg_ros.diagnosis.search.tried import Progress, staged
from pierburg_ros.diagnosis.simulation import reproduction
from pierburg_ros.diagnosis.verdict.conclusion import conclude, verdict_on
from pierburg_ros.diagnosis.verdict.shares import Shares, shares
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data, data_of, in_parts
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording


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

    `progress` is told what is being tried; `jobs` is the number of fits at a time, by default one for each core. After
    `budget` [s] of an idle machine (`Deadline`), or Ctrl-C, the best verdict yet is given and marked as such; without a
    budget it takes what it takes.
    InputError where the recordings cannot be used. Recordings of the user's own `simulation` stand for the nominal
    model: `nominal` is then fitted to them first. Where signals are not what they are read as, that is all that is
    said, unless it goes on by `force`.
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
    deadline = Deadline(budget)
    # what repeats itself with every turn is read from the balance of torques, not searched for order by order
    beam = Beam(depth=0) if has_overtones(data, nominal) else None
    found = search(data, nominal, progress, jobs, beam, deadline)
    if verdict_on(found.chosen) == "unexplained" and len(recordings) == 1:
        before = found
        found = deadline.attempt(lambda: apart(before, recordings[0], progress, jobs, deadline), before)
    rest = None
    if verdict_on(found.chosen) == "unexplained" and (doubt := _doubt(found, recordings)):
        found, rest = replace(found, data=replace(found.data, remarks=(*found.data.remarks, doubt))), unnamed(found)
    elif verdict_on(found.chosen) == "unexplained":
        tell = staged(progress, "what remains")
        rest = deadline.attempt(lambda: remainder(found, tell, jobs, deadline), unexamined(found))
    conclusion = conclude(found, rest)
    if found.data.disturbed:
        conclusion = replace(conclusion, verdict="unexplained")
    parts = deadline.attempt(
        lambda: shares(found, conclusion.recalibrated, conclusion.final, conclusion.model), Shares({}, None)
    )
    excluded = limits(found, conclusion.final, progress, jobs, deadline)
    written = document(found, conclusion, parts, excluded, deadline.stopped)
    shown = signals(longest(data), conclusion)
    result = Result(written, conclusion.model, data.runs, shown, exhibits(found, conclusion))
    return simulator.told(result) if simulator else result


def _doubt(found: Found, recordings: Sequence[Recording]) -> str | None:
    """Why nothing that is left of a recording may be named."""
    return rounded(found, recordings[0]) if len(recordings) == 1 else None


def evidence(recordings: Sequence[Recording], nominal: Model) -> Data:
    """The recordings split into samples that train, validate and test; InputError where they cannot be used."""
    refuse_unusable(recordings, nominal.actuator)
    actuator = nominal.actuator
    for recording in recordings:
        if recording.quantity != actuator.quantity:
            raise InputError(
                f"{recording.name} holds {recording.quantity}, but actuator {actuator.name} measures "
                f"{actuator.quantity}. Choose the actuator that was recorded."
            )
    return in_parts(data_of(recordings, nominal))
