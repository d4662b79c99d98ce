"""Recordings of a real rotor: what repeats itself with every turn is the same in each of them."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.torque_balance import TURN, Balance, over_a_turn
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "odrive"
ROTOR = Model.nominal(read_actuator("odrive"))
ANGLE = np.linspace(0.0, TURN, 1000)


def balance_of(path: Path) -> tuple[float, Balance]:
    """Lag of the recorded current [s] and the torque over a turn, from one run."""
    time, counts, current = np.load(path)
    kept = np.concatenate([[True], np.diff(time) > 0.0])
    time, angle = time[kept] - time[0], counts[kept] * TURN / 8192
    recording = Recording(path.stem, "position", time, angle, Channel(time, current[kept]), input="current")
    run = data_of([recording], ROTOR).runs[0]
    seen = np.ones(run.time.size, dtype=bool)
    return run.input_lag, over_a_turn(ROTOR, [(run.inputs, run.time, run.measured, seen)])


@pytest.mark.skipif(not DATA.is_dir(), reason="the ODrive recordings (../shared/data) are not here")
def test_maps_over_a_turn_from_different_recordings_agree() -> None:
    found = [balance_of(path) for path in sorted(DATA.glob("slow2_*.npy"))]
    assert len(found) == 3
    for lag, balance in found:
        assert 0.05 < lag < 0.12
        assert balance.orders[np.argmax(np.hypot(balance.cosines, balance.sines))] == 7
    for (_, one), (_, other) in combinations(found, 2):
        assert np.corrcoef(one.torque(ANGLE), other.torque(ANGLE))[0, 1] > 0.95
