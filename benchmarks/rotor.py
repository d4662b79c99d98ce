"""Cogging of a real rotor: each recording diagnosed by itself, and how well the maps over a turn agree.

`python benchmarks/rotor.py [--shared FOLDER] [--budget EFFORT]` prints what is found. The recordings are
those of `data/odrive` in the shared folder; nothing of them is part of the package.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.io import loadmat

import pierburg_ros as pr
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Estimate
from pierburg_ros.plant import Model
from pierburg_ros.plant.torques import load
from pierburg_ros.recording import Channel, Recording

COUNTS = 8192
"""Counts of the encoder in a turn."""
TURN = np.linspace(0.0, 2.0 * math.pi, 1000)
SPINS = 50
"""Steps of current in the recording of the rotor spinning up."""


def main() -> None:
    """Diagnose every recording by itself and print what was named, and the correlations of the maps."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shared", type=Path, default=Path("../shared"))
    parser.add_argument("--budget", default="1")
    parser.add_argument("--spins", action="store_true", help="the steps of the rotor spinning up, too")
    options = parser.parse_args()
    folder = options.shared / "data/odrive"
    recordings = [*slow(folder), *(spins(folder) if options.spins else ())]
    maps = {}
    for recording in recordings:
        began = time.perf_counter()
        found = pr.diagnose(recording, actuator="odrive", budget=options.budget)
        maps[recording.name] = over_a_turn(found.model)
        print(row(recording.name, found, time.perf_counter() - began), flush=True)
    print(np.array2string(np.corrcoef(list(maps.values())), precision=3))


def row(name: str, found: pr.Diagnosis, seconds: float) -> str:
    """A row of the table: name, effects with their numbers, error on unseen samples before and after, time."""
    errors = found.document.fit.validation
    named = "; ".join(
        f"{each.id} {numbers(each.parameters)} ({each.confidence:.2f})" for each in found.document.effects
    )
    return (
        f"| `{name}` | {found.verdict} | {named or 'nothing'} | {errors.recalibrated_rmse:.2g} |"
        f" {errors.final_rmse:.2g} | {seconds:.0f} |"
    )


def numbers(parameters: dict[str, Estimate]) -> str:
    return ", ".join(f"{name} {each.value:.3g}" for name, each in parameters.items())


def over_a_turn(model: Model) -> Signal:
    """Load torque of `model` over a turn [N.m], the mean left out: its cogging and what else repeats itself."""
    record = model.record()[0]
    torque = np.array([load.load_at(record, angle, 0.0, 0.0) + load.ripple(record, angle) for angle in TURN])
    return torque - np.mean(torque)


def slow(folder: Path) -> Iterator[Recording]:
    """The runs that turn slowly under a controller: time [s], counts, measured current [A]."""
    for path in sorted(folder.glob("slow2_*.npy")):
        yield recorded(path.stem, *np.load(path))


def spins(folder: Path) -> Iterator[Recording]:
    """Each step of the current that turns the rotor round: a second each, cells of current, time, position, current."""
    data = loadmat(folder / "spinup_4_nocomp.mat")["data"]
    for number in range(SPINS):
        time_, position, current = (data[line, number].ravel() for line in (1, 2, 3))
        if np.ptp(position) > COUNTS:
            yield recorded(f"spinup_4_nocomp, step {number}", time_, position, current)


def recorded(name: str, time_: Signal, position: Signal, current: Signal) -> Recording:
    kept = np.concatenate([[True], np.diff(time_) > 0.0])
    time_ = time_[kept] - time_[0]
    angle = 2.0 * math.pi / COUNTS * position[kept]
    return Recording(name, "position", time_, angle, Channel(time_, current[kept]), input="current")


if __name__ == "__main__":
    main()
