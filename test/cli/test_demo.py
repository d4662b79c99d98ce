"""What `pierburg demo` conceals is found, in a recording of the same loop made without a graph."""

import json
from pathlib import Path

import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.cli.demo import CONCEALED, NOISE, write_setpoints
from pierburg_ros.plant import read_model


def run(*arguments: object) -> None:
    with pytest.raises(SystemExit) as ending:
        main(list(map(str, arguments)))
    assert ending.value.code == 0


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """The concealed valve under the controller, with the demo's setpoints and noise."""
    setpoints = tmp_path / "setpoints.csv"
    write_setpoints(setpoints)
    run("simulate", "--model", CONCEALED, "--setpoints", setpoints, "--noise", NOISE, "--output", tmp_path / "run")
    return tmp_path / "run/simulated.mcap"


def test_the_concealed_effect_is_named_alone_beside_the_drift(recording: Path, tmp_path: Path) -> None:
    run("diagnose", recording, "--output", tmp_path / "diagnosis")
    found = json.loads((tmp_path / "diagnosis/diagnosis.json").read_text())
    assert found["verdict"] == "missing_physics"
    assert [effect["id"] for effect in found["effects"]] == ["static_friction"]
    assert [name for name, value in found["parameters"].items() if value["drifted"]] == ["spring_preload"]
    torque = found["effects"][0]["parameters"]["breakaway_torque"]["value"]
    assert torque == pytest.approx(read_model(CONCEALED).values["static_friction.breakaway_torque"], rel=0.03)
