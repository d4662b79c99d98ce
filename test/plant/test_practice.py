"""Recordings of an independent simulator, replayed with what was hidden in them: down to the stated noise."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Recording, read_recording

PRACTICE = Path(__file__).resolve().parents[2] / ".." / "shared" / "practice"
NOMINAL = Model.nominal(read_actuator("pierburg"))
UNLABELLED_PHASE = ("cogging_torque", "external_load")

if not PRACTICE.is_dir():
    pytest.skip("the practice recordings (../shared/practice) are not on this machine", allow_module_level=True)


def labelled(folder: Path) -> tuple[Model, dict[str, Any]]:
    """The model that the truth file describes, and the file."""
    truth = json.loads((folder / "truth.json").read_text())
    values = dict(truth["drifted"])
    for effect in truth["effects"]:
        values |= {f"{effect['id']}.{name}": p["value"] for name, p in effect["parameters"].items()}
    return NOMINAL.with_values(values), truth


def residual(model: Model, recording: Recording) -> float:
    """RMS of measured minus simulated [V]."""
    inputs = Inputs(recording.command.time, recording.command.values)
    return float(np.sqrt(np.mean((recording.measured - simulate(model, inputs, recording.time)) ** 2)))


def with_fitted_phase(model: Model, recording: Recording, name: str) -> Model:
    """The model with the phase that fits best: scanned, then refined."""

    def at(phase: float) -> float:
        return residual(model.with_values({name: phase}), recording)

    scan = np.linspace(-np.pi, np.pi, 41)
    best = scan[np.argmin([at(phase) for phase in scan])]
    refined = minimize_scalar(at, bounds=(best - 0.16, best + 0.16), method="bounded")
    return model.with_values({name: float(refined.x)})


@pytest.mark.parametrize("folder", sorted(PRACTICE.glob("practice-*")), ids=lambda folder: folder.name)
@pytest.mark.parametrize("part", ("train", "holdout"))
def test_truth_leaves_only_the_noise(folder: Path, part: str) -> None:
    model, truth = labelled(folder)
    if truth["not_in_catalogue"]:
        pytest.skip(f"{truth['not_in_catalogue']} is not in the catalogue")
    recording = read_recording(folder / f"{part}.mcap")
    for effect in truth["effects"]:
        if effect["id"] in UNLABELLED_PHASE and "phase" not in effect["parameters"]:
            model = with_fitted_phase(model, recording, f"{effect['id']}.phase")
    assert residual(model, recording) <= 1.05 * truth["noise_volts"]
