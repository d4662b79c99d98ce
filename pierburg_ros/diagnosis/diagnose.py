"""From recordings to a diagnosis: the whole path, one step after the other."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.audit import audit
from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.diagnosis.cleaning.cleaned import cleaned
from pierburg_ros.diagnosis.found import found
from pierburg_ros.diagnosis.quality import untelling
from pierburg_ros.diagnosis.report.exhibits import exhibits
from pierburg_ros.diagnosis.report.findings import document, signals
from pierburg_ros.diagnosis.report.refusal import refusal
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.simulation import reproduction
from pierburg_ros.inference.infer import infer
from pierburg_ros.inference.search import Progress
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers


def diagnose(
    recordings: Sequence[Recording],
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    budget: Budget = USUAL_BUDGET,
    simulation: Sequence[Recording] = (),
    force: bool = False,
) -> Result:
    """Locate, name and model what `nominal` lacks, from recordings alone, with `jobs` fits at a time (all cores).

    `progress` is given what is being tried. Where the `budget` is spent, or after Ctrl-C, the result is the best
    verdict so far, marked as such. If recordings of the user's own `simulation` are given, these replace the nominal
    model: `nominal` is fitted to them first. If signals are not what they are read as, or tell nothing of the physics,
    only that is reported, unless `force` is set. InputError if the recordings cannot be used.
    """
    each_cleaned = [cleaned(recording, number) for number, recording in enumerate(recordings)]
    recordings = [each.recording for each in each_cleaned]
    if faults := [] if force else audit(recordings, nominal) or untelling(recordings, nominal):
        return refusal(recordings, nominal, faults)
    simulator = reproduction(simulation, recordings, nominal, progress, jobs) if simulation else None
    own, unlike = (simulator.model, simulator.left) if simulator else (nominal, 0.0)
    inferred = infer(recordings, own, progress, jobs, budget, unlike)
    progress("what is ruled out, and what remains")
    with workers(jobs) as pool:
        told = found(inferred, pool)
    written = document(told, each_cleaned)
    result = Result(written, told.model, told.data.runs, signals(told), exhibits(told, each_cleaned))
    return simulator.told(result) if simulator else result
