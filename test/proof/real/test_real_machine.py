"""Real recordings as the proof takes them up: halves, files that are written again, strengths."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model
from pierburg_ros.proof.real.channels import channels_of, logged, with_effect, write
from pierburg_ros.proof.real.machine import Machine, machine_in
from pierburg_ros.proof.real.strengths import possible, strength, tellable, values_at
from pierburg_ros.proof.real.trial import added
from pierburg_ros.recording import Channel, Recording, read_recording
from pierburg_ros.recording.loss import Loss

VALVE, SERVO, ARM = (Model.nominal(read_actuator(name)) for name in ("pierburg", "xl330", "ak80"))
TIME = np.arange(300) * 0.005


def recorded(**changes):
    """A servo's recording in steps of 0.001 rad."""
    angle = 0.001 * np.round(400.0 * np.sin(4.0 * TIME))
    whole = Recording(
        "run",
        "position",
        TIME,
        angle,
        Channel(TIME[::2] - 0.05, 0.3 * np.sign(np.sin(7.0 * TIME[::2]))),
        supply_voltage=Channel(TIME[::3], 7.4 + 0.1 * np.sin(TIME[::3])),
        enabled=Channel(TIME[:2], np.array([1.0, 0.0])),
    )
    return replace(whole, **changes)


def test_a_recording_written_again_is_the_same(tmp_path):
    write(tmp_path / "again.mcap", recorded())
    again = read_recording(tmp_path / "again.mcap")
    assert again.input == "duty" and again.quantity == "position" and not again.losses
    assert again.time == pytest.approx(TIME, abs=2e-9)
    assert np.array_equal(again.measured, recorded().measured)
    for signal in ("command", "supply_voltage", "enabled"):
        one, other = getattr(again, signal), getattr(recorded(), signal)
        assert one.time == pytest.approx(other.time, abs=2e-9) and np.array_equal(one.values, other.values)


def test_what_a_sensor_effect_gives_is_in_steps_of_the_recordings_converter():
    lagged = with_effect(recorded(), "sensor_lag", {"time_constant": 0.03}, SERVO).measured
    assert lagged / 0.001 == pytest.approx(np.round(lagged / 0.001), abs=1e-6)
    assert np.max(np.abs(lagged - recorded().measured)) > 0.02


def test_noise_comes_after_the_sensor():
    """A lag leaves a fiftieth of white noise; what is logged has as much as was recorded, and the same each time."""
    noise = 0.01 * np.random.default_rng(1).standard_normal(TIME.size)
    original, lagged = np.sin(4.0 * TIME) + noise, np.sin(4.0 * TIME - 0.1) + 0.02 * noise
    shown = logged(TIME, lagged, original)
    assert np.std(shown - lagged) == pytest.approx(0.01, rel=0.15)
    assert np.array_equal(shown, logged(TIME, lagged, original))
    assert np.array_equal(logged(TIME, original, original), original)


def test_a_coarser_converter_takes_the_place_of_the_recordings():
    coarse = with_effect(recorded(), "sensor_quantization", {"step": 0.0073}, SERVO).measured
    assert coarse / 0.0073 == pytest.approx(np.round(coarse / 0.0073), abs=1e-6)


def test_a_delayed_recording_keeps_all_but_the_times_of_its_command():
    late = with_effect(recorded(), "input_delay", {"delay": 0.02}, SERVO)
    assert late.command.time == pytest.approx(recorded().command.time - 0.02)
    assert np.array_equal(late.measured, recorded().measured)
    assert np.array_equal(late.supply_voltage.time, recorded().supply_voltage.time)


def test_the_sensor_of_a_hall_voltage_has_its_ends():
    hall = recorded(quantity="hall_voltage", measured=0.42 + np.linspace(0.0, 1.0, 300))
    given = channels_of(hall, VALVE)
    assert given.zero == pytest.approx(0.42)
    assert given.zero + given.per_radian * given.span == pytest.approx(4.52)


def folder_of(path: Path, names=("a", "b", "c")) -> Path:
    """A folder of recordings."""
    for name in names:
        write(path / f"{name}.mcap", recorded())
    return path


def test_every_other_recording_belongs_to_a_half_and_the_rest_model_it(tmp_path):
    machine = machine_in(folder_of(tmp_path), SERVO, read_recording)
    assert [machine.half(name) for name in machine.recordings] == [0, 1, 0]
    assert list(machine.others(0)) == ["b"] and list(machine.others(1)) == ["a", "c"]


def test_a_recording_that_lacks_messages_is_left_out(tmp_path):
    def read(path):
        recording = read_recording(path)
        return recording if path.stem != "b" else replace(recording, losses=(Loss("duty", 3, 100, ((0.1, 0.2),)),))

    machine = machine_in(folder_of(tmp_path), SERVO, read)
    assert list(machine.recordings) == ["a", "c"]
    assert machine.left_out[0].startswith("b.mcap: ")


def test_a_single_recording_is_refused_unless_the_model_is_known(tmp_path):
    folder = folder_of(tmp_path, ("a",))
    with pytest.raises(InputError, match="holds 1 whole recordings, expected two or more of one machine"):
        machine_in(folder, SERVO, read_recording)
    assert list(machine_in(folder, SERVO, read_recording, known=True).recordings) == ["a"]


def test_no_folder_is_refused(tmp_path):
    with pytest.raises(InputError, match="is no folder, expected one that holds recordings"):
        machine_in(tmp_path / "none", SERVO, read_recording)


def test_what_can_be_put_in_depends_on_drive_and_sensor():
    assert "sensor_nonlinearity" in possible(VALVE.actuator)
    assert "sensor_nonlinearity" not in possible(SERVO.actuator)
    assert "pwm_deadband" in possible(SERVO.actuator) and "pwm_deadband" not in possible(ARM.actuator)
    assert set(tellable(ARM.actuator)) == {"torque_scale", "total_inertia", "coulomb_friction"}


def test_strengths_go_from_plain_to_half_of_the_limit():
    ruled_out = [{"id": "sensor_lag", "parameter": "time_constant", "below": 0.002}]
    plain, between, limit, half = (
        strength("sensor_lag", level, SERVO, ruled_out) for level in ("plain", "between", "limit", "half")
    )
    assert (limit, half) == (0.002, 0.001)
    assert between == pytest.approx(np.sqrt(plain * limit)) and plain > between > limit
    assert strength("sensor_lag", "limit", SERVO, []) is None
    above = [{"id": "sensor_lag", "parameter": "time_constant", "below": 2.0 * plain}]
    assert strength("sensor_lag", "between", SERVO, above) is None


def test_plain_is_the_same_for_a_machine_of_another_size():
    """A servo ten times as slow has a plain lag ten times as long."""
    slow = SERVO.with_values({})
    scaled = replace(
        SERVO.actuator,
        parameters={
            name: replace(
                each, default=each.nominal * {"torque_constant": 10.0, "armature_resistance": 10.0}.get(name, 1)
            )
            for name, each in SERVO.actuator.parameters.items()
        },
    )
    ratio = strength("sensor_lag", "plain", Model.nominal(scaled), []) / strength("sensor_lag", "plain", slow, [])
    assert ratio == pytest.approx(10.0)


def test_what_is_put_in_adds_to_what_is_there():
    own = SERVO.with_values({"input_delay.delay": 0.005, "sensor_quantization.step": 0.001})
    assert added("input_delay", values_at("input_delay", 0.02, own), own) == {"input_delay.delay": 0.025}
    assert added("sensor_quantization", values_at("sensor_quantization", 0.02, own), own) == {
        "sensor_quantization.step": 0.02
    }


def test_a_machine_is_called_as_its_actuator():
    assert Machine(SERVO, {}).name == "xl330"
