"""Whole runs: inputs checked at the edge, many at once equal to one by one."""

from __future__ import annotations

import numpy as np
import pytest
from reference.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate, simulate_many

NOMINAL = Model.nominal(read_actuator("pierburg"))


@pytest.mark.parametrize(
    ("time", "duty", "message"),
    (
        ([], [], "input times are empty or do not increase"),
        ([0.0, 0.0], [0.1, 0.2], "do not increase"),
        ([0.0, 1.0], [0.1], "2 times and 1 values of duty"),
        ([0.0, np.nan], [0.1, 0.2], "do not increase"),
        ([0.0, 1.0], [0.1, np.nan], "duty is not finite"),
    ),
)
def test_unusable_inputs_are_refused(time: list[float], duty: list[float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Inputs(np.array(time), np.array(duty))


@pytest.mark.parametrize("samples", ([], [0.0, 0.0], [1.0, 0.5], [0.0, np.nan]))
def test_unusable_sample_times_are_refused(samples: list[float]) -> None:
    with pytest.raises(InputError, match="sample times"):
        simulate(NOMINAL, Inputs(np.array([0.0]), np.array([0.1])), samples)


def test_duty_is_zero_before_its_first_row() -> None:
    time = np.arange(0.0, 1.0, 0.01)
    voltage = simulate(NOMINAL, Inputs(np.array([0.5]), np.array([0.3])), time)
    assert np.ptp(voltage[time <= 0.5]) == 0.0 and voltage[-1] > 0.5


def test_rows_before_the_first_sample_are_in_force() -> None:
    time = np.arange(10.0, 11.0, 0.01)
    early = simulate(NOMINAL, Inputs(np.array([3.0, 9.0]), np.array([0.1, 0.3])), time)
    assert np.array_equal(early, simulate(NOMINAL, Inputs(np.array([10.0]), np.array([0.3])), time))


@pytest.mark.parametrize("threads", (1, 2, None))
def test_many_are_the_single_runs(threads: int | None) -> None:
    time, duty = rich_duty(3.0)
    models = [NOMINAL.with_values({"armature_resistance": r}) for r in np.linspace(4.0, 5.0, 9)]
    together = simulate_many(models, Inputs(time, duty), time, threads=threads)
    assert together.shape == (9, time.size)
    for model, row in zip(models, together, strict=True):
        assert np.array_equal(row, simulate(model, Inputs(time, duty), time))
