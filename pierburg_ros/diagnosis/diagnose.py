"""From recordings to a diagnosis: the whole path."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.diagnosis.evidence.quality import refuse_unusable
from pierburg_ros.diagnosis.limits.limits import limits
from pierburg_ros.diagnosis.remainder.remainder import remainder
from pierburg_ros.diagnosis.report.exhibits import exhibits
from pierburg_ros.diagnosis.report.findings import document, longest, signals
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.diagnosis.search.search import Progress
from pierburg_ros.diagnosis.verdict.conclusion import conclude, verdict_on
from pierburg_ros.diagnosis.verdict.shares import shares
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data, data_of, in_parts
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers


def diagnose(
    recordings: Sequence[Recording],
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
) -> Result:
    """Locate, name and model what `nominal` lacks, from recordings alone, with `jobs` fits at a time (all cores).

    `progress` is told what is being tried; `jobs` is the number of fits at a time, by default one for each core.
    InputError where the recordings cannot be used.
    """
    data = evidence(recordings, nominal)
    found = search(data, nominal, progress, jobs)
    rest = remainder(found, progress, jobs) if verdict_on(found.chosen) == "unexplained" else None
    conclusion = conclude(found, rest)
    parts = shares(found, conclusion.recalibrated, conclusion.final, conclusion.model)
    with workers(jobs) as pool:
        excluded = limits(found, conclusion.final, pool, progress)
    written = document(found, conclusion, parts, excluded)
    shown = signals(longest(data), conclusion)
    return Result(written, conclusion.model, data.runs, shown, exhibits(found, conclusion))


def evidence(recordings: Sequence[Recording], nominal: Model) -> Data:
    """The recordings split into samples that train, validate and test; InputError where they cannot be used."""
    refuse_unusable(recordings, nominal.scales)
    actuator = nominal.actuator
    for recording in recordings:
        if recording.quantity != actuator.quantity:
            raise InputError(
                f"{recording.name} holds {recording.quantity}, but actuator {actuator.name} measures "
                f"{actuator.quantity}. Choose the actuator that was recorded."
            )
    return in_parts(data_of(recordings, nominal))
