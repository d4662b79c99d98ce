"""`pierburg diagnose` as a person meets it: files, exit status, and that it reads nothing but the signals."""

import json
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.plant import Inputs, Model, read_model, simulate
from pierburg_ros.recording import write_simulated

pytestmark = pytest.mark.search

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as ending:
        main(["diagnose", "--thorough", *arguments])
    return ending.value.code


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """20 s of random duty steps through a valve whose sensor lags by 12 ms, 3 mV of noise."""
    random = np.random.default_rng(5)
    time = np.arange(0.0, 20.0, 0.002)
    duty = random.uniform(-0.05, 0.36, 40)[(time / 0.5).astype(int)]
    duty[time < 0.2] = 0.0
    model = Model.nominal(read_actuator("pierburg")).with_values({"sensor_lag.time_constant": 0.012})
    hall = simulate(model, Inputs(time, duty), time) + 0.003 * random.standard_normal(time.size)
    path = tmp_path_factory.mktemp("recording") / "train.mcap"
    write_simulated(path, time, duty, hall)
    return path


def with_everything_else(source: Path, target: Path) -> None:
    """A copy that also tells, in topics, metadata and attachments, what no diagnosis may read."""
    with source.open("rb") as stream, target.open("wb") as out:
        writer = Writer(out)
        writer.start(profile="ros2", library="test")
        telltale = writer.register_schema("rcl_interfaces/msg/ParameterEvent", "ros2msg", b"string node")
        channels = {}
        for schema, channel, message in make_reader(stream).iter_messages():
            if channel.topic not in channels:
                known = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, "cdr", known)
            writer.add_message(
                channels[channel.topic], message.log_time, message.data, message.publish_time, message.sequence
            )
        for topic in ("/parameter_events", "/rosout", "/diagnostics", "/plant/parameters"):
            writer.add_message(writer.register_channel(topic, "cdr", telltale), 1, b"\0\1\0\0sensor_lag 0.012", 1)
        writer.add_metadata("truth", {"sensor_lag.time_constant": "0.012"})
        writer.add_attachment(0, 0, "truth.json", "application/json", b'{"effect": "sensor_lag"}')
        writer.finish()


def test_names_the_effect_and_writes_every_file(recording: Path, tmp_path: Path, capsys) -> None:
    assert run(str(recording), "--output", str(tmp_path / "out")) == 0
    document = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert document["schema"] == 3
    assert document["verdict"] == "missing_physics"
    assert [effect["id"] for effect in document["effects"]] == ["sensor_lag"]
    assert document["fit"]["validation"]["final_rmse"] < 1.1 * 0.003
    assert read_model(tmp_path / "out" / "model.yaml").active_effects == ("sensor_lag",)
    assert (tmp_path / "out" / "overview.png").stat().st_size > 10_000
    assert "sensor lag" in (tmp_path / "out" / "report.html").read_text()
    assert "missing physics" in capsys.readouterr().out


def test_parameters_logs_metadata_and_attachments_change_nothing(recording: Path, tmp_path: Path) -> None:
    told = tmp_path / "told" / "train.mcap"
    told.parent.mkdir()
    with_everything_else(recording, told)
    for source, name in ((recording, "plain"), (told, "telling")):
        assert run(str(source), "--output", str(tmp_path / name)) == 0
    documents = [(tmp_path / name / "diagnosis.json").read_bytes() for name in ("plain", "telling")]
    assert documents[0] == documents[1]


def test_a_missing_file_is_one_line_and_leaves_nothing(tmp_path: Path, capsys) -> None:
    assert run(str(tmp_path / "no.mcap"), "--output", str(tmp_path / "out")) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_a_recording_that_is_too_short_is_refused(tmp_path: Path, capsys) -> None:
    time = np.arange(0.0, 0.5, 0.002)
    write_simulated(tmp_path / "short.mcap", time, np.zeros(time.size), np.full(time.size, 0.42))
    assert run(str(tmp_path / "short.mcap"), "--output", str(tmp_path / "out")) == 2
    assert "too short" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_without_movement_nothing_is_claimed(tmp_path: Path) -> None:
    time = np.arange(0.0, 20.0, 0.002)
    hall = 0.42 + 0.003 * np.random.default_rng(1).standard_normal(time.size)
    write_simulated(tmp_path / "still.mcap", time, np.zeros(time.size), hall)
    assert run(str(tmp_path / "still.mcap"), "--output", str(tmp_path / "out")) == 0
    document = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert document["verdict"] == "unexplained" and document["summary"].startswith("Nothing is concluded")
    assert document["effects"] == [] and "The shaft never moves" in document["input_faults"][0]["evidence"]
    assert run(str(tmp_path / "still.mcap"), "--force", "--output", str(tmp_path / "out")) == 0
    document = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert document["verdict"] == "consistent"
    assert document["effects"] == []
    assert document["data_quality"]["limits"]
    assert len(document["not_testable"]) >= 15


def test_a_worn_valve_under_the_controller_lacks_stiction_and_nothing_else(tmp_path: Path) -> None:
    """The walk of the README: few jumps, so that a fit stops in a local minimum, where a ripple would seem to help."""
    sources = ["--model", str(EXAMPLES / "worn_valve.yaml"), "--setpoints", str(EXAMPLES / "setpoints.csv")]
    with pytest.raises(SystemExit):
        main(["simulate", *sources, "--noise", "0.003", "--output", str(tmp_path / "walk")])
    assert run(str(tmp_path / "walk" / "simulated.mcap"), "--output", str(tmp_path / "out")) == 0
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert [effect["id"] for effect in found["effects"]] == ["static_friction"]
    assert found["parameters"]["armature_resistance"]["value"] == pytest.approx(4.55, rel=0.001)
    values = found["effects"][0]["parameters"]
    assert values["breakaway_torque"]["value"] == pytest.approx(0.27, rel=0.01)
    low, high = values["stribeck_velocity"]["ci95"]
    assert low < 0.1 < high
