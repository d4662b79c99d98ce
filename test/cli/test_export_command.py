"""`pierburg export` from the command line: the file, what it lacks, and refusals."""

import json

import pytest

from pierburg_ros.cli.app import main

MODEL = """
actuator: pierburg
effects:
  static_friction: {breakaway_torque: 0.27, stribeck_velocity: 0.1}
  viscous_friction: {coefficient: 0.02}
"""


@pytest.fixture
def model(tmp_path):
    path = tmp_path / "model.yaml"
    path.write_text(MODEL)
    return path


def run(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["export", *map(str, arguments)])
    return ended.value.code


@pytest.mark.parametrize("to", ["mujoco", "urdf", "sdf", "modelica", "json"])
def test_writes_the_file_and_says_so(model, tmp_path, capsys, to):
    output = tmp_path / "new" / "valve"
    assert run(model, "--to", to, "--output", output) == 0
    assert "pierburg" in output.read_text()
    assert f"Written to {output}" in capsys.readouterr().out


def test_a_device_is_written_and_stays_one(model, tmp_path):
    (tmp_path / "link").symlink_to("/dev/null")
    assert run(model, "--to", "json", "--output", tmp_path / "link") == 0
    assert (tmp_path / "link").is_char_device()


def test_what_the_format_cannot_hold_is_listed_by_effect_and_parameter(model, tmp_path, capsys):
    assert run(model, "--to", "urdf", "--output", tmp_path / "valve.urdf") == 0
    told, written = capsys.readouterr().out, (tmp_path / "valve.urdf").read_text()
    for each in ("static_friction.breakaway_torque 0.27 N.m", "static_friction.stribeck_velocity 0.1 rad/s"):
        assert each in told and each in written
    assert "viscous_friction" not in told


def test_json_is_json(model, tmp_path):
    run(model, "--to", "json", "--output", tmp_path / "model.json")
    assert json.loads((tmp_path / "model.json").read_text())["actuator"] == "pierburg"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("MODEL", "--to", "stl", "--output", "OUT"), "There is no format stl; expected mujoco, urdf, sdf, modelica"),
        (("missing.yaml", "--to", "urdf", "--output", "OUT"), "missing.yaml"),
        (("MODEL", "--to", "urdf", "--output", "."), ". is a folder, expected a file to write."),
        (("MODEL", "--to", "urdf"), "Missing option '--output'"),
        (("MODEL", "--to", "urdf", "--output", "MODEL/below"), "cannot be written"),
    ],
)
def test_bad_input_is_one_line_and_status_2(model, tmp_path, capsys, arguments, line):
    places = {"MODEL": str(model), "OUT": str(tmp_path / "out")}
    assert run(*(each.replace("MODEL", places["MODEL"]).replace("OUT", places["OUT"]) for each in arguments)) == 2
    error = capsys.readouterr().err
    assert line in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()
