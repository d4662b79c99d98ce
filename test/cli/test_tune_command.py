"""`pierburg tune` from the command line: the parameter file, the comparison, and refusals."""

import json
from dataclasses import asdict

import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.cli.options.models import chosen_model
from pierburg_ros.closed_loop.corrected import task_for
from pierburg_ros.closed_loop.course import Course
from pierburg_ros.closed_loop.goal import Goal
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


@pytest.fixture
def lagging(tmp_path):
    """A corrected model with a sensor that lags."""
    path = tmp_path / "model.yaml"
    path.write_text(
        "actuator: pierburg\nparameters: {hall_voltage_closed: 0.44}\neffects: {sensor_lag: {time_constant: 0.009}}\n"
    )
    return path


def test_a_corrected_model_gets_a_better_loop_and_says_what_to_expect(lagging, tmp_path, capsys):
    file = tmp_path / "controller.yaml"
    assert run("--model", lagging, "-o", file, "--json", *QUICK) == 0
    found = json.loads(capsys.readouterr().out)
    settings = read_parameter_file(file)
    assert found["settings"] == asdict(settings)
    assert (settings.predictor_lag, settings.hall_voltage_closed) == (0.009, 0.44)
    before, after = (found["predicted"]["nominal"][when] for when in ("before", "after"))
    assert before["overshoot"] > 0.2 and after["overshoot"] < 0.05
    assert after["hunting"] < 0.005 and after["settling"] < 1.5 * before["settling"]


def test_tuning_gives_nothing_worse_than_what_is_in_use(lagging, tmp_path, capsys):
    first, second = tmp_path / "first.yaml", tmp_path / "second.yaml"
    assert run("--model", lagging, "-o", first, *QUICK, "--seed", 3) == 0
    assert run("--model", lagging, "-o", second, "--controller", first, *QUICK, "--seed", 4) == 0
    assert "before -> after" in capsys.readouterr().out
    task = task_for(chosen_model(lagging, None), Goal())
    costs = [task.cost(read_parameter_file(path), Course()) for path in (first, second)]
    assert costs[1] <= costs[0]


def test_the_predictor_can_be_left_out(lagging, tmp_path):
    assert run("--model", lagging, "--no-predictor", "-o", tmp_path / "plain.yaml", *QUICK) == 0
    assert read_parameter_file(tmp_path / "plain.yaml").predictor_lag == 0.0


@pytest.mark.parametrize(("option", "scheduled"), [((), True), (("--no-schedule",), False)])
def test_a_model_without_delay_or_lag_gets_a_schedule_unless_told_otherwise(option, scheduled, tmp_path, capsys):
    model, file = tmp_path / "model.yaml", tmp_path / "controller.yaml"
    model.write_text("actuator: pierburg\nparameters: {spring_preload: 0.35}\n")
    assert run("--model", model, "-o", file, *option, *QUICK) == 0
    settings = read_parameter_file(file)
    assert (settings.load_closed > 0.12) is scheduled
    assert settings.load_share == 0.0 or scheduled


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--predictor",), "but no model"),
        (("--schedule",), "but no model"),
        (("--actuator", "pierburg", "--predictor"), "neither dead time nor lag"),
        (("--actuator", "xl330"), "the controller is tuned for a duty, a Hall voltage and a spring"),
        (("--actuator", "pierburg", "--compare", "control.md"), "Found --compare with a model"),
    ],
)
def test_what_cannot_be_tuned_for_is_one_line(options, reason, tmp_path, capsys):
    assert run(*options, "-o", tmp_path / "controller.yaml", *QUICK) == 2
    said = capsys.readouterr().err
    assert reason in said and said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("options", [("--settling", "0.5"), ("--members", "1"), ("--output", ".")])
def test_bad_input_is_one_line_and_leaves_nothing(options, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("--output", "controller.yaml", *options) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
