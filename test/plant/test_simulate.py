"""Whole runs: inputs checked at the edge, many at once equal to one by one."""

from __future__ import annotations

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate, simulate_many

NOMINAL = Model.nominal(read_actuator("pierburg"))


@pytest.mark.parametrize(
    ("time", "duty", "message"),
    (
        ([], [], "input times are empty or do not increase"),
        ([0.0, 0.0], [0.1, 0.2], "do not increase"),
        ([0.0, 1.0], [0.1], "2 times and 1 values of command"),
        ([0.0, np.nan], [0.1, 0.2], "do not increase"),
        ([0.0, 1.0], [0.1, np.nan], "command is not finite"),
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


def test_inputs_told_at_more_moments_drive_alike() -> None:
    given = Inputs(np.array([0.2, 0.5]), np.array([0.3, 0.1]), np.array([13.0, 12.0]), np.array([True, False]))
    told = given.at(np.array([0.1, 0.2, 0.3, 0.5, 0.7]))
    assert told.command.tolist() == [0.0, 0.3, 0.3, 0.1, 0.1]
    assert told.supply_voltage is not None and told.supply_voltage.tolist() == [13.0, 13.0, 13.0, 12.0, 12.0]
    time = np.arange(0.0, 1.0, 0.01)
    assert np.allclose(simulate(NOMINAL, told, time), simulate(NOMINAL, given, time), atol=1e-6)


def test_rows_before_the_first_sample_are_in_force() -> None:
    time = np.arange(10.0, 11.0, 0.01)
    early = simulate(NOMINAL, Inputs(np.array([3.0, 9.0]), np.array([0.1, 0.3])), time)
    assert np.array_equal(early, simulate(NOMINAL, Inputs(np.array([10.0]), np.array([0.3])), time))


@pytest.mark.parametrize(
    ("begin", "values"),
    (
        (2.0021, {"input_delay.delay": 0.03}),
        (1.9921, {"armature_inductance.inductance": 0.02}),
        (2.0021, {"armature_inductance.inductance": 0.02, "input_delay.delay": 0.013}),
        (1.9921, {"external_load.torque": 0.2, "external_load.start": 2.3, "external_load.end": 2.8}),
        (1.9921, {"external_load.amplitude": 0.05, "external_load.frequency": 1.7, "external_load.phase": 0.4}),
    ),
)
def test_a_run_taken_up_in_a_standstill_goes_on_as_the_whole_run(begin: float, values: dict[str, float]) -> None:
    """The shaft rests against its spring; a duty sent just before is still on its way, or still drives its current."""
    model = NOMINAL.with_values(values)
    inputs = Inputs(np.array([0.0, 0.3, 0.7, 1.985, 2.0, 2.6]), np.array([0.0, 0.26, 0.2, 0.19, 0.27, 0.0]))
    time = np.arange(0.0, 3.5, 0.002)
    whole = simulate(model, inputs, time)
    late = time >= begin
    rest = whole[(time > 1.9) & (time < begin)]
    assert np.ptp(rest) < 1e-9 and np.ptp(whole[late]) > 0.5
    angle = (rest[0] - 0.42) / 4.1 * np.pi / 2
    taken_up = simulate(model, inputs, time[late], angle)
    assert np.max(np.abs(taken_up - whole[late])) < 1e-4


@pytest.mark.parametrize("jobs", (1, 2, None))
def test_many_are_the_single_runs(jobs: int | None) -> None:
    time, duty = rich_duty(3.0)
    models = [NOMINAL.with_values({"armature_resistance": r}) for r in np.linspace(4.0, 5.0, 9)]
    together = simulate_many(models, Inputs(time, duty), time, jobs=jobs)
    assert together.shape == (9, time.size)
    for model, row in zip(models, together, strict=True):
        assert np.array_equal(row, simulate(model, Inputs(time, duty), time))
