"""`pierburg tune` from the command line: the parameter file, the comparison, and refusals."""

import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.control import read_parameter_file

pytestmark = pytest.mark.search

QUICK = ("--generations", "0", "--members", "4")


@pytest.fixture(autouse=True)
def few_plants(monkeypatch):
    """The plants with stated goals and one more; the whole set takes minutes."""
    from pierburg_ros.closed_loop.plants import plant_set
    from pierburg_ros.closed_loop.tune import STATED

    plants = {name: model for name, model in plant_set().items() if name in (*STATED, "sensor lag")}
    monkeypatch.setattr("pierburg_ros.cli.tune.plant_set", lambda: plants)


def run(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["tune", *map(str, arguments)])
    return ended.value.code


def test_writes_a_parameter_file_that_the_controller_takes(tmp_path, capsys):
    assert run("--output", tmp_path / "controller.yaml", *QUICK) == 0
    settings = read_parameter_file(tmp_path / "controller.yaml")
    assert settings.proportional_gain == 1.0
    assert "not validated on a real valve" in (tmp_path / "controller.yaml").read_text()
    assert "share of the goal" in capsys.readouterr().out


def test_the_comparison_has_all_three_controllers(tmp_path):
    document = tmp_path / "control.md"
    document.write_text("# Control\n\nText.\n")
    assert run("--output", tmp_path / "controller.yaml", "--compare", document, *QUICK) == 0
    text = document.read_text()
    assert text.startswith("# Control\n\nText.\n")
    assert all(f"| {name} |" in text for name in ("PIFLC", "PI", "PID"))


def test_the_goal_can_be_stated(tmp_path):
    run("--output", tmp_path / "loose.yaml", "--hunting", 5, "--settling", 50, *QUICK)
    run("--output", tmp_path / "tight.yaml", *QUICK)
    loose, tight = ((tmp_path / name).read_text().splitlines()[1] for name in ("loose.yaml", "tight.yaml"))
    assert float(loose.split("hunting ")[1]) < float(tight.split("hunting ")[1])


@pytest.mark.parametrize("options", [("--settling", "0.5"), ("--members", "1"), ("--output", ".")])
def test_bad_input_is_one_line_and_leaves_nothing(options, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("--output", "controller.yaml", *options) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
