"""The command line: cheap to list, one line on bad input, nothing half-written."""

import subprocess
import sys
from types import SimpleNamespace

import pytest

from pierburg_ros.actuators import SHIPPED
from pierburg_ros.cli import app
from pierburg_ros.cli.options import models
from pierburg_ros.cli.options.recordings import topics_of
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import output_folder
from pierburg_ros.starting import NODES

LATER = {"experiment", "prove", "tune"}
"""Commands whose help loads what they work with."""


def ending(arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        app.main(arguments)
    return ended.value.code


@pytest.fixture
def command(monkeypatch):
    """Puts a function in the place of the tune command."""

    def place(function):
        monkeypatch.setattr(app, "import_module", lambda name: SimpleNamespace(tune=function))

    return place


def test_help_lists_every_command_of_the_contract(capsys):
    assert ending([]) == 0
    listed = capsys.readouterr().out
    for name in ("demo", "run", "simulate", "experiment", "identify", "replay", "diagnose", "prove", "tune"):
        assert f" {name} " in listed


@pytest.mark.parametrize("name", ["", *sorted(set(app.COMMANDS) - LATER)])
def test_help_imports_neither_compiler_nor_libraries(name):
    script = (
        f"import sys\nfrom pierburg_ros.cli.app import main\ntry:\n    main({[*name.split(), '--help']})\n"
        "except SystemExit:\n"
        "    print([name for name in ('numba', 'scipy', 'numpy', 'plotly', 'rclpy') if name in sys.modules])"
    )
    shown = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert shown.splitlines()[-1] == "[]"


def test_the_actuators_that_the_options_name_are_those_that_are_shipped():
    assert models.SHIPPED == SHIPPED


def test_an_input_error_is_one_line_and_status_2(command, capsys):
    def tune() -> None:
        raise InputError("found a cat,\n  expected a dog. Bring a dog.")

    command(tune)
    assert ending(["tune"]) == 2
    assert capsys.readouterr().err == "pierburg: found a cat, expected a dog. Bring a dog.\n"


def test_a_file_that_cannot_be_opened_is_one_line_and_status_2(command, capsys, tmp_path):
    def tune() -> None:
        (tmp_path / "absent").read_text()

    command(tune)
    assert ending(["tune"]) == 2
    assert capsys.readouterr().err == f"pierburg: {tmp_path}/absent: No such file or directory.\n"


def test_a_fault_of_the_program_is_not_hidden(command):
    def tune() -> None:
        raise ZeroDivisionError

    command(tune)
    with pytest.raises(ZeroDivisionError):
        app.main(["tune"])


def test_an_interruption_ends_with_130(command):
    def tune() -> None:
        raise KeyboardInterrupt

    command(tune)
    assert ending(["tune"]) == 130


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["repla"], "pierburg: No such command 'repla'. Did you mean 'replay'? See 'pierburg --help'.\n"),
        (["tune", "--fast"], "pierburg: No such option: --fast. See 'pierburg tune --help'.\n"),
    ],
)
def test_a_usage_error_is_one_line_and_status_2(command, capsys, arguments, line):
    def tune() -> None:
        """Tune."""

    command(tune)
    assert ending(arguments) == 2
    assert capsys.readouterr().err == line


def test_a_choice_that_does_not_exist_is_answered_with_the_nearest(capsys):
    assert ending(["actuator", "chck", "pierburg"]) == 2
    said = capsys.readouterr().err  # older typer names the argument by its choices
    assert said.lower().startswith("pierburg: invalid value for 'action")
    end = "': 'chck' is not one of 'new', 'check'. Did you mean check? See 'pierburg actuator --help'.\n"
    assert said.endswith(end) and said.count("\n") == 1


def test_results_appear_only_when_all_is_done(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "old.json").write_text("old")
    with pytest.raises(InputError), output_folder(tmp_path / "out") as folder:
        (folder / "new.json").write_text("half")
        raise InputError("no")
    assert [path.name for path in tmp_path.rglob("*")] == ["out", "old.json"]
    with output_folder(tmp_path / "deep" / "er") as folder:
        (folder / "plots").mkdir()
        (folder / "plots" / "new.json").write_text("whole")
    assert (tmp_path / "deep" / "er" / "plots" / "new.json").read_text() == "whole"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["deep", "out"]


def test_an_output_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(InputError, match="out is a file, expected a folder"), output_folder(tmp_path / "out"):
        pass
    assert (tmp_path / "out").read_text() == "mine"


def test_the_list_of_commands_names_every_node():
    assert all(node in app.COMMANDS["run"].summary for node in NODES)


@pytest.mark.parametrize(
    ("arguments", "before"),
    [
        (["tune", "-o", ""], "-o"),
        (["tune", "--output="], "--output"),
        (["replay", "", "-o", "x"], "replay"),
    ],
)
def test_an_empty_argument_is_refused_and_named(capsys, arguments, before):
    assert ending(arguments) == 2
    line = f"pierburg: Found nothing in the argument behind {before}, expected a value. Give one.\n"
    assert capsys.readouterr().err == line


def test_topics_are_named_by_role():
    assert topics_of(["duty=/a/pwm", "hall_voltage=/b"]) == {"duty": "/a/pwm", "hall_voltage": "/b"}
    with pytest.raises(InputError, match=r"--topic found '/a/pwm', expected SIGNAL=NAME"):
        topics_of(["/a/pwm"])
