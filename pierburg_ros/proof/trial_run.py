"""One trial from its draw to its score, each stage leaving files in the trial's folder.

train.mcap                  what the diagnosis gets, under a name that says nothing
truth.json, holdout.mcap    sealed by seal.json before the diagnosis starts
diagnosis/                  what the diagnosis said
result.json                 the score, and the versions of the sources it belongs to
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pierburg_ros.arrays import Signal
from pierburg_ros.comparison.compare import compare
from pierburg_ros.errors import InputError
from pierburg_ros.plant import read_model
from pierburg_ros.proof.bench import record
from pierburg_ros.proof.formulation import simulate_textbook
from pierburg_ros.proof.graph import record_over_graph
from pierburg_ros.proof.score import Score, failed, score
from pierburg_ros.proof.seal import SEAL, opened, seal
from pierburg_ros.proof.trial import Trial, concealed_values, truth
from pierburg_ros.proof.visibility import visibility
from pierburg_ros.proof.windows import share_of_best
from pierburg_ros.recording import read_recording

DIAGNOSE = (sys.executable, "-c", "from pierburg_ros.cli.app import main; main()", "diagnose")
"""The command as a process of its own; the recording and `--output DIR` follow."""
GIVEN = {"recording.mcap": "train.mcap"}
"""What a diagnosis gets, under a name that says nothing, and the file of the trial that it is."""
LONGEST_DIAGNOSIS = 900.0  # s, after which a diagnosis counts as failed
RESULT = "result.json"


def prepare(trial: Trial, folder: Path) -> None:
    """Record the trial and seal its truth, unless that is done."""
    if (folder / SEAL).exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    if trial.over_graph:
        run = record_over_graph(trial, folder / "train.mcap")
        record_over_graph(trial, folder / "holdout.mcap", holdout=True)
    else:
        run = record(trial)
        run.write(folder / "train.mcap")
        record(trial, holdout=True).write(folder / "holdout.mcap")
    seal(folder, finite({**truth(trial), "visibility": visibility(trial, run).label()}))


def diagnose(
    folder: Path,
    command: Sequence[str] = DIAGNOSE,
    given: Mapping[str, str] = GIVEN,
    longest: float = LONGEST_DIAGNOSIS,
) -> float:
    """Diagnose in a separate process what is `given`, which sees nothing else; gives the time it took [s].

    `given` is the file in `folder` of each file that the process finds: recordings to diagnose, and what the `command`
    names. After the `longest` time [s] it counts as failed.
    """
    with tempfile.TemporaryDirectory() as place:
        for name, file in given.items():
            shutil.copy(folder / file, Path(place) / name)
        recordings = [str(Path(place) / name) for name in given if name.endswith(".mcap")]
        asked = [*command, *recordings, "--output", str(Path(place) / "diagnosis")]
        environment = {**os.environ, "COLUMNS": "120"}
        started = time.perf_counter()
        try:
            ended = subprocess.run(
                asked,
                cwd=place,
                capture_output=True,
                text=True,
                timeout=longest,
                env=environment,
                start_new_session=True,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise InputError(f"the diagnosis did not end within {longest:.0f} s") from None
        taken = time.perf_counter() - started
        if ended.returncode != 0:
            last = (ended.stderr.strip().splitlines() or ["no message"])[-1]
            raise InputError(f"the diagnosis ended with status {ended.returncode}: {last}")
        shutil.rmtree(folder / "diagnosis", ignore_errors=True)
        shutil.move(Path(place) / "diagnosis", folder / "diagnosis")
    return taken


def judge(folder: Path) -> Score:
    """Open the seal and score the diagnosis that lies in the folder."""
    label = opened(folder)
    diagnosis = json.loads((folder / "diagnosis" / "diagnosis.json").read_text())
    windows = share_of_best(*effect_signal(label, folder), diagnosis.get("locations", []))
    return score(label, diagnosis, windows, unseen_rmse(folder))


def effect_signal(label: Mapping[str, Any], folder: Path) -> tuple[Signal, Signal]:
    """Time [s] and what the concealed effect adds to the Hall voltage [V], drift being in both."""
    recording = read_recording(folder / "train.mcap")
    duty = recording.command.at(recording.time, before=0.0)
    effects, drifted = concealed_values(label)
    with_effect, without = (
        simulate_textbook(values, recording.time, duty) for values in ({**drifted, **effects}, drifted)
    )
    return recording.time, with_effect - without


def unseen_rmse(folder: Path) -> float | None:
    """RMSE of the diagnosed model on the unseen recording [V]; None where the diagnosis left no model."""
    model = folder / "diagnosis" / "model.yaml"
    if not model.exists():
        return None
    return float(compare(read_model(model), read_recording(folder / "holdout.mcap")).rmse)


def conduct(trial: Trial, folder: Path, version: str, command: Sequence[str] = DIAGNOSE) -> dict[str, Any]:
    """Run one trial as far as it is not done, and give its result; `version` is that of the sources."""
    done = result(folder, version)
    if done is not None:
        return done
    prepare(trial, folder)
    try:
        taken = diagnose(folder, command)
        scored = replace(judge(folder), seconds=taken)
    except InputError as problem:
        scored = failed(opened(folder), str(problem))
    label: dict[str, Any] = finite({**scored.label(), "sources": version})
    temporary = folder / f".{RESULT}"
    temporary.write_text(json.dumps(label, indent=1))
    temporary.replace(folder / RESULT)
    return label


def result(folder: Path, version: str) -> dict[str, Any] | None:
    """The trial's result, if it was reached with this version of the sources."""
    try:
        label: dict[str, Any] = json.loads((folder / RESULT).read_text())
    except FileNotFoundError:
        return None
    return label if label["sources"] == version else None


def finite(value: Any) -> Any:
    """The same content with null for every number that JSON cannot hold."""
    if isinstance(value, Mapping):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
