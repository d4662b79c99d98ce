"""The example of a user's own actuator can be read and simulated."""

from pathlib import Path

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

ROOT = Path(__file__).parents[2]


def test_the_example_reaches_its_open_stop_at_full_duty_and_returns_at_none() -> None:
    actuator = read_actuator(ROOT / "examples/my_actuator.yaml")
    time = np.arange(0.0, 4.0, 0.002)
    hall = simulate(Model.nominal(actuator), Inputs(np.array([0.0, 2.0]), np.array([1.0, 0.0])), time)
    open_stop = 0.5 + 4.0 * 1.5 / (np.pi / 2)
    assert abs(hall[999] - open_stop) < 1e-9
    assert abs(hall[-1] - 0.5) < 1e-9
