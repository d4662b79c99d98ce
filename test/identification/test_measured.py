"""Recordings of real machines of other kinds: a torque-driven pendulum and a current-driven rotor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pierburg_ros as pr

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data"


def rotor_as_csv(source: Path, folder: Path) -> Path:
    """A run of the rotor as a table: time [s], current [A], position [rad] of 8192 counts a turn."""
    time, counts, current = np.load(source)
    kept = np.concatenate([[True], np.diff(time) > 0.0])
    columns = (time[kept] - time[0], current[kept], counts[kept] * 2.0 * np.pi / 8192.0)
    path = folder / f"{source.stem}.csv"
    np.savetxt(path, np.column_stack(columns), delimiter=",", header="time,current,position", comments="", fmt="%.9g")
    return path


@pytest.mark.skipif(not (DATA / "ak80").is_dir(), reason="the AK80 recordings (../shared/data) are not here")
def test_one_run_of_the_pendulum_is_explained_four_times_better_once_identified() -> None:
    recording = pr.read(DATA / "ak80/ddp.csv")
    nominal = pr.compare(recording, pr.Model.nominal("ak80"))
    found = pr.identify(recording, actuator="ak80")
    assert nominal.rmse < 0.05 and found.rmse < 0.25 * nominal.rmse
    # shooting by others gave 0.36 to 0.43 kg.m where mass and length say 0.304: a scale of 0.71 to 0.84
    assert 0.7 < found.model.values["torque_scale"] < 0.9


@pytest.mark.skipif(not (DATA / "odrive").is_dir(), reason="the ODrive recordings (../shared/data) are not here")
def test_one_run_of_the_rotor_is_replayed_and_identified(tmp_path: Path) -> None:
    recording = pr.read(rotor_as_csv(DATA / "odrive/slow2_nocomp_0.npy", tmp_path))
    assert recording.input == "current" and recording.quantity == "position"
    nominal = pr.compare(recording, pr.Model.nominal("odrive"))
    found = pr.identify(recording, actuator="odrive")
    assert found.rmse < 0.5 * nominal.rmse
