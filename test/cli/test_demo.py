"""The demo on recordings of the same loop that were made without a graph: what it conceals is found."""

import json
import shutil
from pathlib import Path

import pytest

from pierburg_ros.cli import demo
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


def test_the_demo_names_the_concealed_effect_alone_beside_the_drift_and_ends_on_that(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(demo, "require_ros", lambda: None)
    monkeypatch.setattr(demo, "recorded_run", lambda folder, name, *_: shutil.copy(recording, folder / name))
    monkeypatch.chdir(tmp_path)
    run("demo", "--output", "demo")
    found = json.loads((tmp_path / "demo/diagnosis/diagnosis.json").read_text())
    assert found["verdict"] == "missing_physics"
    assert [effect["id"] for effect in found["effects"]] == ["static_friction"]
    assert [name for name, value in found["parameters"].items() if value["drifted"]] == ["spring_preload"]
    torque = found["effects"][0]["parameters"]["breakaway_torque"]["value"]
    assert torque == pytest.approx(read_model(CONCEALED).values["static_friction.breakaway_torque"], rel=0.03)
    assert capsys.readouterr().out.splitlines()[-1].startswith("Results in demo: replay.html (the loop), ")
    assert "pierburg diagnose demo/demo.mcap --model demo/model.yaml" in (tmp_path / "demo/replay.html").read_text()
    report = (tmp_path / "demo/diagnosis/report.html").read_text()
    assert "pierburg replay demo/concealed.mcap --model demo/diagnosis/model.yaml" in report
