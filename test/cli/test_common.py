"""What every command shares, over all commands: help, options, JSON, silence, suggestions, endings."""

import inspect
import json
import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer

from pierburg_ros.cli import app
from pierburg_ros.cli.console.terminal import terminal

COMMANDS = tuple(app.COMMANDS)
DOCUMENT = {"verdict": "consistent", "value": 1.5}
EXAMPLES = [pytest.param(name, each, id=each) for name in COMMANDS for each in app.COMMANDS[name].examples]


def ending(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        app.main(list(map(str, arguments)))
    return ended.value.code


@pytest.fixture
def replaced(monkeypatch):
    """Puts a function in the place of every command."""

    def place(function):
        monkeypatch.setattr(app, "import_module", lambda name: SimpleNamespace(**dict.fromkeys(COMMANDS, function)))

    return place


def talkative():
    """A command that prints, shows progress, and has a result."""

    def command(output: Path | None = None) -> dict[str, object]:
        terminal().print("a result")
        terminal(stderr=True).print("progress")
        return DOCUMENT

    return command


def help_of(name: str, monkeypatch, capsys, columns: int = 80) -> str:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert ending(name, "-h") == 0
    return capsys.readouterr().out


def command_named(name: str):
    """The command as Typer has it."""
    return typer.main.get_command(app.application(name)).commands[name]


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("columns", [60, 80, 120])
def test_help_fits_the_terminal_and_is_complete(name, columns, monkeypatch, capsys):
    shown = help_of(name, monkeypatch, capsys, columns)
    assert max(map(len, shown.splitlines())) <= columns
    assert "…" not in shown
    flat = " ".join(shown.split())
    for parameter in command_named(name).params:
        for option in parameter.opts if parameter.param_type_name == "option" else ():
            assert option in flat
        if getattr(parameter, "help", None):
            assert " ".join(parameter.help.split()) in flat


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_the_common_options(name):
    options = {option for each in command_named(name).params for option in each.opts}
    assert {"--output", "-o", "--quiet", "--json"} <= options


@pytest.mark.parametrize("name", COMMANDS)
def test_help_is_the_same_for_h_and_shows_examples(name, monkeypatch, capsys):
    short = help_of(name, monkeypatch, capsys)
    assert ending(name, "--help") == 0
    assert capsys.readouterr().out == short
    assert app.COMMANDS[name].examples
    for example in app.COMMANDS[name].examples:
        assert f"\n    {example}\n" in short


@pytest.mark.parametrize(("name", "example"), EXAMPLES)
def test_examples_are_command_lines_that_the_command_takes(name, example):
    program, called, *arguments = shlex.split(example.partition(" > ")[0])
    assert (program, called) == ("pierburg", name)
    command_named(name).make_context(name, arguments)


@pytest.mark.parametrize("name", COMMANDS)
def test_json_is_all_that_goes_to_standard_output(name, replaced, capsys):
    replaced(talkative())
    assert ending(name, "--json") == 0
    said = capsys.readouterr()
    assert json.loads(said.out) == DOCUMENT
    assert "progress" in said.err


@pytest.mark.parametrize("name", COMMANDS)
def test_quiet_prints_nothing(name, replaced, capsys):
    replaced(talkative())
    assert ending(name, "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert ending(name, "--quiet", "--json") == 0
    said = capsys.readouterr()
    assert json.loads(said.out) == DOCUMENT and said.err == ""


@pytest.mark.parametrize("name", COMMANDS)
def test_what_a_command_gives_is_a_document(name):
    """A command that gave nothing would print null for --json."""
    assert inspect.signature(command_function(name)).return_annotation not in (None, "None")


def command_function(name: str):
    module = __import__(f"pierburg_ros.cli.{name}", fromlist=[name])
    return getattr(module, name)


def test_a_command_without_an_output_writes_its_document(replaced, tmp_path, capsys):
    replaced(lambda: DOCUMENT)
    assert ending("inspect", "-o", tmp_path / "found.json") == 0
    assert json.loads((tmp_path / "found.json").read_text()) == DOCUMENT
    assert ending("inspect", "-o", tmp_path) == 2
    assert "is a folder, expected a file" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ("inspect", "none.mcap", "-o"),
        ("inspect", "none.mcap", "--write-signals"),
        ("tune", "--controller", "none.yaml", "-o"),
        ("actuator", "new"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_the_work(arguments, capsys):
    assert ending(*arguments, "/proc/x/y") == 2
    line = "pierburg: /proc/x/y cannot be written, since /proc cannot. Choose another place.\n"
    assert capsys.readouterr().err == line


@pytest.mark.parametrize("name", COMMANDS)
def test_a_misspelt_command_is_suggested(name, capsys):
    assert ending(name[:-1] + "x") == 2
    said = capsys.readouterr().err
    assert f"Did you mean '{name}'" in said and said.count("\n") == 1


@pytest.mark.parametrize("name", [name for name in COMMANDS if name != "run"])
def test_a_misspelt_option_is_suggested(name, capsys):
    """`run` hands what it does not know to ROS."""
    assert ending(name, "--quite") == 2
    said = capsys.readouterr().err
    assert "No such option: --quite. Did you mean" in said and "--quiet" in said and said.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (["replay", "run.mcap", "--actuator", "pierbrug", "-o", "out"], "pierburg"),
        (["replay", "run.mcap", "--model", "odd.yaml", "-o", "out"], "armature_resistance"),
        (["replay", "run.mcap", "--model", "effect.yaml", "-o", "out"], "static_friction"),
        (["replay", "run.mcap", "--model", "parameter.yaml", "-o", "out"], "breakaway_torque"),
        (["experiment", "ritch", "-o", "out"], "rich"),
        (["experiment", "--discriminate", "nominal", "backlas", "-o", "out"], "backlash"),
        (["export", "right.yaml", "--to", "mujocco", "-o", "out"], "mujoco"),
        (["run", "plnt"], "plant"),
        (["prove", "--only", "drfit", "-o", "out"], "drift"),
        (["simulate", "--setpoints", "s.csv", "--controller", "gains.yaml", "-o", "out"], "integral_gain"),
    ],
)
def test_misspelt_names_are_suggested(arguments, meant, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name, content in {
        "odd": "actuator: pierburg\nparameters: {armature_resistence: 4.1}\n",
        "effect": "actuator: pierburg\neffects: {static_fricton: {breakaway_torque: 0.3}}\n",
        "parameter": "actuator: pierburg\neffects: {static_friction: {breakaway_torqe: 0.3}}\n",
        "right": "actuator: pierburg\n",
        "gains": "/**:\n  ros__parameters: {integral_gian: 2.0}\n",
    }.items():
        Path(f"{name}.yaml").write_text(content)
    Path("s.csv").write_text("time,setpoint\n0,0\n1,0.5\n")
    assert ending(*arguments) == 2
    said = capsys.readouterr().err
    assert f"Did you mean {meant}?" in said and said.count("\n") == 1


@pytest.mark.parametrize("name", COMMANDS)
def test_an_interruption_is_one_line_and_130(name, replaced, capsys):
    def command() -> None:
        raise KeyboardInterrupt

    replaced(command)
    assert ending(name) == 130
    assert capsys.readouterr() == ("", "pierburg: interrupted.\n")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_knows_commands_options_and_gives_a_script(shell):
    def asked(typed: str, instruction: str = "complete") -> str:
        script = "from pierburg_ros.cli.app import main; main()"
        asking = {"_PIERBURG_COMPLETE": f"{instruction}_{shell}", "_TYPER_COMPLETE_ARGS": typed, "COMP_WORDS": typed}
        number = {"COMP_CWORD": str(len(typed.split(" ")) - 1), "_TYPER_COMPLETE_FISH_ACTION": "get-args"}
        return subprocess.run(
            [sys.executable, "-c", script], env={**environment(), **asking, **number}, capture_output=True, text=True
        ).stdout

    assert "recover" in asked("pierburg rec") and "replay" not in asked("pierburg rec")
    assert re.search(r"--fix\b", asked("pierburg identify --fi"))
    assert "pierburg" in asked("pierburg", "source")


def environment() -> dict[str, str]:
    import os

    return {**os.environ, "PYTHONPATH": str(Path(app.__file__).parents[2])}


def test_no_colour_where_none_is_wanted(monkeypatch, capsys):
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert ending("actuator", "check", "pierburg") == 0
    assert "\x1b[3" not in capsys.readouterr().out
