"""A comparison measures what it says, and a graph's recording replayed with its parameters leaves noise."""

import json
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.comparison.compare import Comparison, compare
from pierburg_ros.plant import Model, Plant
from pierburg_ros.recording import Channel, Recording, read_recording
from pierburg_ros.recording.formats.cdr import encode_float64
from pierburg_ros.recording.formats.mcap_writer import McapWriter
from pierburg_ros.recording.write import joint_state

PRACTICE = Path(__file__).parents[2] / "../shared/practice"
NOMINAL = Model.nominal(read_actuator("pierburg"))
NOISE = 0.003
TOPICS = {
    "/duty": "std_msgs/msg/Float64",
    "/hall_voltage": "std_msgs/msg/Float64",
    "/applied_duty": "std_msgs/msg/Float64",
    "/joint_states": "sensor_msgs/msg/JointState",
}


def made(residual: np.ndarray, rate: float = 100.0) -> Comparison:
    """A comparison with a given residual of a signal that swings by 1 V about 2 V."""
    time = np.arange(residual.size) / rate
    measured = 2.0 + np.where(np.arange(residual.size) % 2, 1.0, -1.0)
    duty = Channel(np.zeros(1), np.zeros(1))
    return Comparison(Recording("made", "hall_voltage", time, measured, duty), NOMINAL, measured - residual)


def test_rmse_and_variance_explained():
    comparison = made(np.full(1000, 0.5))
    assert comparison.rmse == pytest.approx(0.5)
    assert comparison.variance_explained == pytest.approx(0.75)


def test_the_worst_stretch_is_where_the_residual_is():
    residual = np.full(1000, 0.01)
    residual[400:500] = 1.0
    worst = made(residual).worst
    assert (worst.start, worst.end) == (4.0, 4.99)
    assert worst.rmse == pytest.approx(1.0) and worst.share == pytest.approx(100 / (100 + 900e-4))


def test_what_does_not_exist_is_null():
    time = 0.01 * np.arange(50)
    recording = Recording("still", "hall_voltage", time, np.full(50, 0.42), Channel(np.zeros(1), np.zeros(1)))
    result = compare(NOMINAL, recording).as_mapping()
    assert result["variance_explained"] is None and result["rmse"] == pytest.approx(0.0, abs=1e-12)
    assert json.loads(json.dumps(result, allow_nan=False)) == result


def drive(ticks: int, period: float) -> np.ndarray:
    """Duty commands that open, hold, close and jump, one for each tick."""
    time = period * np.arange(ticks)
    return np.clip(0.2 + 0.25 * np.sin(1.3 * time) + 0.2 * np.sign(np.sin(2.1 * time)), -0.3, 0.6)


def record_graph(path: Path, with_stamps: bool) -> float:
    """Record what a plant at 500 Hz publishes in 20 s; returns the noise that its sensor had [V].

    The command that acts from a tick on was published 1.2 to 1.7 ms before it. All messages leave late by a
    varying delay, and only `joint_states` carries the time of the tick.
    """
    period, ticks, start = 0.002, 10_000, 10**12
    late = np.random.default_rng(5).uniform(0.0001, 0.0006, ticks)
    plant, command = Plant(NOMINAL, noise=NOISE, seed=3), drive(ticks, period)
    errors = np.empty(ticks)
    with path.open("wb") as stream, McapWriter(stream) as writer:
        for topic, kind in TOPICS.items():
            if with_stamps or topic not in ("/applied_duty", "/joint_states"):
                writer.declare(topic, kind)
        for k in range(ticks):
            true = 0.42 + 4.1 * plant.angle / (np.pi / 2)
            hall = plant.measure()
            errors[k] = hall - true
            tick, leaves = start + k * 2_000_000, start + round((k * period + late[k]) * 1e9)
            values = {"/hall_voltage": hall, "/duty": command[k], "/applied_duty": command[k]}
            for topic in writer.topics:
                data = joint_state(tick, 0.0) if topic == "/joint_states" else float64(values[topic])
                when = leaves - 1_800_000 if topic == "/duty" else leaves
                writer.write(topic, data, when, when, k)
            plant.advance(command[k], period)
    return float(np.std(errors))


def float64(value: float) -> bytes:
    """One std_msgs/Float64."""
    return encode_float64(np.array([value]))[0]


def test_a_recorded_graph_replays_to_within_the_noise_of_its_sensor(tmp_path):
    noise = record_graph(tmp_path / "graph.mcap", with_stamps=True)
    comparison = compare(NOMINAL, read_recording(tmp_path / "graph.mcap"))
    assert comparison.recording.time_source == "stamp"
    assert comparison.rmse <= 1.01 * noise
    assert comparison.variance_explained > 0.9999


def test_without_stamps_the_graph_adds_the_delay_of_its_messages(tmp_path):
    """Full speed is 35 mV a millisecond: samples late by up to 0.6 ms and duties early by 1.5 ms show."""
    noise = record_graph(tmp_path / "graph.mcap", with_stamps=False)
    comparison = compare(NOMINAL, read_recording(tmp_path / "graph.mcap"))
    assert comparison.recording.time_source == "publish"
    assert noise < comparison.rmse < 0.035


@pytest.mark.skipif(not PRACTICE.exists(), reason="the practice recordings are not beside this checkout")
def test_an_independent_simulator_agrees_on_its_own_parameters():
    """practice-00 comes from another simulator; its truth states the noise, 4 mV."""
    folder = PRACTICE / "practice-00"
    truth = json.loads((folder / "truth.json").read_text())
    values = dict(truth["drifted"])
    for effect in truth["effects"]:
        values |= {f"{effect['id']}.{name}": item["value"] for name, item in effect["parameters"].items()}
    comparison = compare(NOMINAL.with_values(values), read_recording(folder / "train.mcap"))
    assert comparison.rmse <= 1.05 * truth["noise_volts"]
