"""A real pendulum under torque: what is said of one run, and of four, and what that is worth on the runs left out.

    python benchmarks/pendulum.py [--shared FOLDER] [--output FOLDER] [--budget SECONDS] [--jobs N]

prints what is found. What the output folder holds already is not diagnosed again. The recordings are those
of `data/ak80` in the shared folder; nothing of them is part of the package.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pierburg_ros.diagnosis.disturbance.touched import untouched
from pierburg_ros.diagnosis.report.horizons import horizons
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.estimation.data import Data, all_training, data_of, in_parts
from pierburg_ros.estimation.estimator import Estimator

import pierburg_ros as pr
from pierburg_ros.actuators import read_actuator
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording, read_recording

RUNS = ("ddp", "direct_collocation", "ilqr", "energy_shaping", "sac")
NOMINAL = Model.nominal(read_actuator("ak80"))


def main() -> None:
    """Diagnose every run by itself and every four of them, and print what each is worth on the others."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shared", type=Path, default=Path("../shared"))
    parser.add_argument("--output", type=Path, default=Path("pendulum"))
    parser.add_argument("--budget", type=float, default=120.0)
    parser.add_argument("--jobs", type=int)
    given = parser.parse_args()
    runs = {name: read_recording(given.shared / f"data/ak80/{name}.csv") for name in RUNS}
    sets = {name: [name] for name in RUNS} | {f"no_{out}": [name for name in RUNS if name != out] for out in RUNS}
    print("| diagnosed | verdict | names | drifts | RMSE [rad] nominal, re-estimated, final on unseen runs |")
    print("|---|---|---|---|---|")
    for label, seen in sets.items():
        folder = given.output / label
        if not (folder / "diagnosis.json").exists():
            found = pr.diagnose([runs[name] for name in seen], actuator="ak80", budget=given.budget, jobs=given.jobs)
            found.save(folder)
        document = json.loads((folder / "diagnosis.json").read_text(encoding="utf-8"))
        models = [NOMINAL, re_estimated([runs[name] for name in seen]), pr.Model.read(folder / "model.yaml")]
        unseen = [as_test(runs[name]) for name in RUNS if name not in seen]
        print(
            f"| {label} | {document['verdict']} | {named(document)} | {drifts(document)} | {errors(unseen, models)} |"
        )


def re_estimated(recordings: list[Recording]) -> Model:
    """The description with its numbers fitted to recordings, but for stretches in which the shaft was pushed."""
    data = data_of(recordings, NOMINAL)
    kept = all_training(untouched(data, NOMINAL, recordings) or data)
    return Estimator(kept, NOMINAL).fit(Explanation(drifting(NOMINAL))).model


def as_test(recording: Recording) -> Data:
    """A run of which no sample was fitted, without the stretches in which the shaft was pushed."""
    data = in_parts(data_of([recording], NOMINAL))
    kept = untouched(data, NOMINAL, [recording]) or data
    none = [np.zeros(run.time.size, dtype=bool) for run in kept.runs]
    runs = (replace(run, train=each, validation=each) for run, each in zip(kept.runs, none, strict=True))
    return replace(kept, runs=tuple(runs))


def errors(unseen: list[Data], models: list[Model]) -> str:
    """Geometric mean over unseen runs of each horizon's error, of the three models."""
    told = [horizons(data, [(model, None) for model in models]) for data in unseen]
    return "; ".join(" ".join(f"{each:.2g}" for each in row) for row in zip(*map(list, means(told)), strict=True))


def means(told: list[list[Any]]) -> Iterator[list[float]]:
    for key in ("nominal_rmse", "recalibrated_rmse", "final_rmse"):
        rows = [[getattr(horizon, key) for horizon in run] for run in told]
        columns = ([value for value in column if value and math.isfinite(value)] for column in zip(*rows, strict=True))
        yield [float(np.exp(np.mean(np.log(column)))) if column else math.nan for column in columns]


def named(document: dict[str, Any]) -> str:
    return ", ".join(f"{each['id']} ({each['confidence']:.2f})" for each in document["effects"]) or "none"


def drifts(document: dict[str, Any]) -> str:
    changed = {name: each for name, each in document["parameters"].items() if each["drifted"]}
    return ", ".join(f"{name} {each['value']:.3g}" for name, each in changed.items()) or "none"


if __name__ == "__main__":
    main()
