"""One trial on a real recording, from what is put in to its score; each stage leaves files in the trial's folder.

recording.mcap, model.yaml  what the diagnosis gets: the changed recording, and the model of the other half
truth.json                  sealed with them by seal.json before the diagnosis starts
diagnosis/                  what the diagnosis said
result.json                 the score, and the version of the sources it belongs to
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pierburg_ros.effects.put_in import CannotPutIn
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model, read_model
from pierburg_ros.proof.real.channels import with_effect, write
from pierburg_ros.proof.real.machine import Machine
from pierburg_ros.proof.real.score import Score, score
from pierburg_ros.proof.real.strengths import WRONG, strength, values_at
from pierburg_ros.proof.real.trial import UNTOUCHED, WITHHELD, Trial, Truth, added
from pierburg_ros.proof.real.visibility import visibility
from pierburg_ros.proof.seal import opened, seal
from pierburg_ros.proof.trial_run import DIAGNOSE, LONGEST_DIAGNOSIS, RESULT, diagnose, finite, result
from pierburg_ros.recording import Recording, read_recording

RECORDING, MODEL, ANSWER = "recording.mcap", "model.yaml", "diagnosis/diagnosis.json"
NOTHING: dict[str, Any] = {"verdict": "none", "effects": []}


@dataclass(frozen=True)
class Bench:
    """Where the files of a run lie, and how it diagnoses: the `command`, with so many usual efforts."""

    output: Path
    version: str
    budget: float
    command: Sequence[str] = DIAGNOSE

    def diagnose(self, folder: Path, recordings: Mapping[str, str]) -> float:
        """Diagnose `recordings`, the file in `folder` of each, against the model there; gives the time it took [s]."""
        command = (*self.command, "--model", MODEL, "--budget", f"{self.budget:g}")
        return diagnose(folder, command, {**recordings, MODEL: MODEL}, LONGEST_DIAGNOSIS)

    def source(self, name: str) -> Path:
        """The recording called `name`, as it was taken up."""
        return self.output / "recordings" / f"{name}.mcap"

    def recording(self, name: str) -> Recording:
        """The same, read."""
        return read_recording(self.source(name))

    def folder(self, trial: Trial) -> Path:
        """Where a trial's files lie."""
        return self.output / "trials" / trial.name

    def half(self, half: int) -> Path:
        """Where the diagnosis of the recordings that are not in a half lies: its model is what the half is held to."""
        return self.output / f"model-for-half-{half + 1}"

    def model(self, half: int) -> Model:
        """The model that recordings of a half are held against: diagnosed from the others, or else given."""
        diagnosed = self.half(half) / "diagnosis" / MODEL
        return read_model(diagnosed if diagnosed.exists() else self.output / MODEL)

    def untouched(self, trial: Trial) -> dict[str, Any]:
        """The diagnosis of a trial's recording as it is; CannotPutIn where it gave no answer."""
        answer = self.folder(replace(trial, kind=UNTOUCHED, level="plain")) / ANSWER
        if not answer.exists():
            raise CannotPutIn("the recording gives no answer as it is")
        return dict(json.loads(answer.read_text()))


def take_up(machine: Machine, output: Path) -> None:
    """Write the machine's recordings and its described model into a run's folder, in one form."""
    (output / "recordings").mkdir(parents=True, exist_ok=True)
    for name, recording in machine.recordings.items():
        write(output / "recordings" / f"{name}.mcap", recording)
    machine.described.write(output / MODEL)


def diagnose_others(asked: tuple[int, Sequence[str]], bench: Bench) -> dict[str, Any]:
    """Diagnose the recordings that are not in a half, unless that is done; their model then stands for the half.

    `asked` are the half and the names of the recordings; each has the seconds of one trial.
    """
    half, names = asked
    folder = bench.half(half)
    done = result(folder, bench.version)
    if done is not None:
        return done
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(bench.output / MODEL, folder)
    for name in names:
        shutil.copy(bench.source(name), folder)
    seconds = bench.diagnose(folder, {f"{name}.mcap": f"{name}.mcap" for name in names})
    answer = json.loads((folder / ANSWER).read_text())
    effects = [effect["id"] for effect in answer["effects"]]
    label = {"recordings": list(names), "verdict": answer["verdict"], "effects": effects, "seconds": seconds}
    return keep({**label, "sources": bench.version}, folder)


def keep(label: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Write a result into `folder`, whole or not at all."""
    kept: dict[str, Any] = finite(label)
    temporary = folder / f".{RESULT}"
    temporary.write_text(json.dumps(kept, indent=1))
    temporary.replace(folder / RESULT)
    return kept


def prepare(trial: Trial, bench: Bench) -> bool:
    """Change what the trial says and seal it; whether there is such a trial: a level or an exact way may be missing."""
    try:
        recording, model, truth = changed(trial, bench)
    except CannotPutIn:
        return False
    folder = bench.folder(trial)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write(folder / RECORDING, recording)
    model.write(folder / MODEL)
    seal(folder, finite(truth.label()), (RECORDING, MODEL))
    return True


def changed(trial: Trial, bench: Bench) -> tuple[Recording, Model, Truth]:
    """The recording and the model of a trial, and what is true of them; CannotPutIn where there is no such trial."""
    model, recording = bench.model(trial.half), bench.recording(trial.recording)
    if trial.kind == UNTOUCHED:
        return recording, model, Truth(trial)
    ruled_out = bench.untouched(trial).get("ruled_out", [])
    if trial.kind == WITHHELD:
        if recording.supply_voltage is None or trial.level != "plain":
            raise CannotPutIn("no supply voltage was recorded, and it is withheld whole or not at all")
        return replace(recording, supply_voltage=None), model, Truth(trial)
    if not trial.is_effect:
        if trial.level not in WRONG:
            raise CannotPutIn(f"a number is not told wrong at the level {trial.level}")
        true, factor = model.values[trial.kind], WRONG[trial.level]
        wrong = model.with_values({trial.kind: factor * true})
        seen = visibility(recording, model, wrong, trial.kind)
        return recording, wrong, Truth(trial, factor, {trial.kind: true}, visibility=seen)
    size, limit = (strength(trial.kind, level, model, ruled_out) for level in (trial.level, "limit"))
    if size is None:
        raise CannotPutIn(f"the untouched recording gives no level {trial.level}")
    values = values_at(trial.kind, size, model)
    both = added(trial.kind, values, model)
    more = model.with_values({f"{trial.kind}.{name}": value for name, value in values.items()} | both)
    seen = visibility(recording, model, more, next(iter(both)))
    return with_effect(recording, trial.kind, values, model), model, Truth(trial, size, both, limit, seen)


def conduct(trial: Trial, bench: Bench) -> dict[str, Any] | None:
    """Conduct a trial unless it is done, and give its result; None where it does not exist."""
    folder = bench.folder(trial)
    done = result(folder, bench.version)
    if done is not None:
        return done
    if not prepare(trial, bench):
        return None
    try:
        seconds = bench.diagnose(folder, {RECORDING: RECORDING})
        scored = replace(judge(trial, bench), seconds=seconds)
    except InputError as problem:
        scored = replace(score(opened(folder), NOTHING, NOTHING), failure=str(problem))
    return keep({**scored.label(), "sources": bench.version}, folder)


def judge(trial: Trial, bench: Bench) -> Score:
    """Open the seal and score the diagnosis that lies in the trial's folder."""
    folder = bench.folder(trial)
    diagnosis = json.loads((folder / ANSWER).read_text())
    return score(opened(folder), diagnosis, diagnosis if trial.kind == UNTOUCHED else bench.untouched(trial))
