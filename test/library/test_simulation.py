"""`pr.simulate` and `pr.Model`: arrays, files and recordings in, a recording out."""

import copy
import pickle

import numpy as np
import pytest

import pierburg_ros as pr
from pierburg_ros.plant import Inputs, simulate

STEP = {"duty": [0.1, 0.2], "time": [0.0, 0.5]}


def test_arrays_drive_the_plant_and_are_sampled_where_they_change(stiff):
    time = np.array([0.0, 0.5, 0.75, 2.0])
    made = pr.simulate(stiff, duty=[0.0, 0.24, 0.3, 0.0], time=time)
    expected = simulate(stiff, Inputs(time, np.array([0.0, 0.24, 0.3, 0.0])), time)
    np.testing.assert_allclose(made.measured, expected, atol=1e-12)
    np.testing.assert_array_equal(made.command, [0.0, 0.24, 0.3, 0.0])


def test_a_rate_and_a_duration_choose_the_samples(stiff):
    made = pr.simulate(stiff, duty=[0.0, 0.24], time=[0.0, 0.5], rate=100.0, duration=3.0)
    np.testing.assert_allclose(made.time, np.arange(301) / 100.0)


def test_a_recording_drives_the_plant_again(simulation, stiff):
    again = pr.simulate(stiff, duty=simulation.recording)
    assert np.std(simulation.measured - again.measured) == pytest.approx(0.003, rel=0.1)


def test_a_saved_simulation_reads_as_it_was(simulation, tmp_path):
    simulation.save(tmp_path)
    recording = pr.read(tmp_path / "simulated.mcap")
    np.testing.assert_array_equal(recording.measured, simulation.measured)
    np.testing.assert_allclose(recording.time, simulation.time, atol=1e-9)
    np.testing.assert_array_equal(recording.command.at(recording.time), simulation.command)


def test_the_controller_brings_the_shaft_to_its_setpoints():
    made = pr.simulate(pr.Model.nominal(), setpoints=[0.0, 0.8], time=[0.0, 0.5])
    assert made.measured[-1] == pytest.approx(0.42 + 4.1 * 0.8 / (np.pi / 2), abs=0.02)
    np.testing.assert_array_equal(made.recording.setpoints.values, [0.0, 0.8])


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({}, "Expected either a duty"),
        ({"duty": [0.1, 0.2]}, "values without their times"),
        ({"duty": [0.1, 0.2], "time": [1.0, 0.5]}, "each after the one before"),
        ({"duty": [0.1], "time": [0.0, 0.5]}, "2 times and 1 values of command"),
        ({"setpoints": [0.1], "time": [0.0, 0.5]}, "2 times and 1 setpoints"),
        ({"duty": [10.0, 20.0], "time": [0.0, 0.5]}, "Divide percentages by 100"),
        ({"duty": [0.1, 0.2], "time": [0.0, 0.5], "controller": "c.yaml"}, "Found a controller with a duty"),
        ({**STEP, "noise": -0.1}, "noise is -0.1; expected 0 to"),
        ({**STEP, "noise": "a"}, "noise is 'a'; expected a number"),
        ({**STEP, "rate": 0.0}, "rate is 0; expected 0.0166667 to 100000 Hz"),
        ({**STEP, "rate": -5.0}, "rate is -5"),
        ({**STEP, "duration": 0.0}, "duration is 0; expected 0.01 to 100000 s"),
        ({**STEP, "duration": -1}, "duration is -1"),
        ({**STEP, "seed": -1}, "seed is -1"),
        ({**STEP, "seed": 1.5}, "seed is 1.5; expected a whole number"),
        ({**STEP, "initial_angle": 45.0}, "initial_angle is 45; expected -0.002 to 1.5728 rad"),
        ({**STEP, "time": np.array([0, 1], "m8[s]")}, "Found time as timedelta64.*, expected real numbers"),
        ({**STEP, "time": np.array([0, 1], "M8[s]")}, "Found time as datetime64"),
        ({**STEP, "duty": np.ma.array([0.1, 0.2], mask=[True, False])}, "Found duty as masked values"),
        ({**STEP, "duty": [0.1, 0.2j]}, "Found duty as complex"),
        ({"setpoints": [0.0, 45.0], "time": [0.0, 0.5]}, "Setpoint 45 rad is beyond the stops"),
        ({"setpoints": [0.0, 0.4], "time": [0.0, 0.5], "initial_angle": 45.0}, "initial_angle is 45"),
        ({"setpoints": [0.0, 0.4], "time": [0.0, 0.5], "controller": {}}, "Found a controller of type dict"),
        ({"duty": "duty.csv", "time": [0.0, 0.5]}, "Found a time beside a file"),
    ],
)
def test_what_cannot_be_simulated_is_refused_with_the_reason(arguments, reason):
    with pytest.raises(pr.InputError, match=reason):
        pr.simulate(pr.Model.nominal(), **arguments)


def test_numbers_of_any_real_kind_are_taken(stiff):
    as_doubles = pr.simulate(stiff, duty=[0.0, 1.0], time=[0.0, 1.0], seed=3, noise=0.01)
    whole = np.array([0, 1])
    taken = pr.simulate(stiff, duty=whole, time=np.ma.array(whole), seed=np.int64(3), noise=np.float64(0.01))
    np.testing.assert_array_equal(taken.measured, as_doubles.measured)


def test_a_setpoint_beyond_a_stop_by_rounding_is_the_stop():
    made = pr.simulate(pr.Model.nominal(), setpoints=[0.0, 1.571], time=[0.0, 0.5])
    np.testing.assert_array_equal(made.recording.setpoints.values, [0.0, np.pi / 2])


def test_a_model_is_read_as_it_was_written_and_stays_one_of_the_librarys(stiff, tmp_path):
    stiff.write(tmp_path / "model.yaml")
    read = pr.Model.read(tmp_path / "model.yaml")
    assert read == stiff and isinstance(read.with_values({"gear_ratio": 37.3}), pr.Model)
    assert pr.compare(pr.simulate(read, duty=[0.0, 0.24], time=[0.0, 1.0], rate=500.0).recording, read).rmse < 1e-9


def test_a_model_can_be_named_by_the_path_of_its_file(stiff, simulation, tmp_path):
    stiff.write(tmp_path / "model.yaml")
    assert pr.compare(simulation.recording, tmp_path / "model.yaml").rmse == pytest.approx(0.003, rel=0.1)


def test_a_missing_recording_is_refused():
    with pytest.raises(pr.InputError, match="There is no recording"):
        pr.identify([])


@pytest.mark.parametrize(
    "change",
    [
        lambda values: values.update(armature_resistance=-3.0),
        lambda values: values.pop("armature_resistance"),
        lambda values: values.__setitem__("armature_resistance", -3.0),
        lambda values: values.__ior__({"armature_resistance": -3.0}),
    ],
)
def test_a_model_never_changes(stiff, change):
    given = dict(stiff.values)
    model = pr.Model(stiff.actuator, given)
    with pytest.raises(TypeError, match="A model never changes"):
        change(model.values)
    given["armature_resistance"] = -3.0
    assert model == stiff and model.values | {"armature_resistance": 5.0} != stiff.values


def test_a_model_is_copied_and_pickled_as_it_is(stiff):
    for made in (copy.copy(stiff), copy.deepcopy(stiff), pickle.loads(pickle.dumps(stiff))):
        assert made == stiff and isinstance(made, pr.Model) and made.with_values({"gear_ratio": 37.3})
        np.testing.assert_array_equal(made.record(), stiff.record())
