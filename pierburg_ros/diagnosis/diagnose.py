"""From recordings to a diagnosis: the whole path."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.audit import audit
from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.evidence.quality import refuse_unusable
from pierburg_ros.diagnosis.limits.limits import Limit, limits
from pierburg_ros.diagnosis.remainder.remainder import remainder, unexamined
from pierburg_ros.diagnosis.report.exhibits import exhibits
from pierburg_ros.diagnosis.report.findings import document, longest, signals
from pierburg_ros.diagnosis.report.refusal import refusal
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.diagnosis.search.search import Progress
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
    faults = [] if force else audit(recordings, nominal)
    if faults:
        return refusal(recordings, nominal, faults)
    simulator = reproduction(simulation, recordings, nominal, progress, jobs) if simulation else None
    nominal = simulator.model if simulator else nominal
    data = evidence(recordings, nominal)
    data = simulator.kept_apart(data) if simulator else data
    deadline = Deadline(budget)
    found = search(data, nominal, progress, jobs, deadline=deadline)
    rest = None
    if verdict_on(found.chosen) == "unexplained":
        rest = deadline.attempt(lambda: remainder(found, progress, jobs, deadline), unexamined(found))
    conclusion = conclude(found, rest)
    parts = deadline.attempt(
        lambda: shares(found, conclusion.recalibrated, conclusion.final, conclusion.model), Shares({}, None)
    )
    excluded = deadline.attempt(lambda: limits(found, conclusion.final, progress, jobs, deadline), list[Limit]())
    written = document(found, conclusion, parts, excluded, deadline.stopped)
    shown = signals(longest(data), conclusion)
    result = Result(written, conclusion.model, data.runs, shown, exhibits(found, conclusion))
    return simulator.told(result) if simulator else result


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
