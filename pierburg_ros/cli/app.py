"""The `pierburg` command and its table of commands.

A command is a function named like its file, `cli/<name>.py`, and an entry in `COMMANDS` with examples. Only the one
that is called is imported, so that listing the commands loads and compiles nothing.

Nothing else is needed for what all commands share, which `application` adds to every function (`cli.common`): -h, -o
beside --output, --quiet, --json, examples in the help, suggestions, completion, endings. The function prints with
`terminal()`, shows progress with `progress()`, and returns its result document for --json.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Annotated, Any

import typer

from pierburg_ros.cli.console.endings import INTERRUPTED, SIGNALS, TERMINATED, Terminated, refuse, terminable, usage
from pierburg_ros.errors import InputError
from pierburg_ros.starting import NODES

SPREAD = ("--simulation",)
"""Options that take every value up to the next option."""
COMPLETING = ("_TYPER_COMPLETE_ARGS", "COMP_WORDS")
"""Variables in which a shell says what has been typed when it asks how that could go on."""
HELP_WIDTH = 100
"""Columns that help texts fill at most. Chosen: longer lines are hard to read."""


@dataclass(frozen=True)
class Command:
    """What the list of commands says about one, without importing it; its `examples` stand at the end of its help."""

    summary: str
    settings: dict[str, Any] = field(default_factory=dict)
    examples: Sequence[str] = ()

    @property
    def epilog(self) -> str:
        """The examples as lines that are not wrapped."""
        return "\b\nExamples:\n" + "\n".join(f"  {example}" for example in self.examples) if self.examples else ""


COMMANDS = {
    "demo": Command(
        "The whole story on a fresh machine: record, replay and diagnose a concealed effect.",
        examples=("pierburg demo", "pierburg demo -o results/demo --json"),
    ),
    "run": Command(
        f"Start one of the nodes: {', '.join(NODES)}.",
        {"allow_extra_args": True, "ignore_unknown_options": True},
        (
            "pierburg run plant --ros-args -p rate:=1000.0",
            "pierburg run controller",
            "pierburg run recorder -o run.mcap",
        ),
    ),
    "simulate": Command(
        "Simulate the open or the closed loop to MCAP, without a ROS graph.",
        examples=(
            "pierburg simulate --duty duty.csv -o simulated",
            "pierburg simulate --setpoints setpoints.csv -o loop",
            "pierburg simulate --model m.yaml --duty run.mcap -o sim",
        ),
    ),
    "experiment": Command(
        "Excitation recipes, and the sequence that best separates two explanations.",
        examples=(
            "pierburg experiment rich -o bench",
            "pierburg experiment rich --graph -o bench",
            "pierburg experiment --discriminate nominal my.yaml -o x",
        ),
    ),
    "identify": Command(
        "Static characteristic, step response and parameters from recordings.",
        examples=(
            "pierburg identify run.mcap -o identified",
            "pierburg identify run.mcap --fix torque_constant -o out",
            "pierburg identify --audit",
        ),
    ),
    "replay": Command(
        "Simulate a recorded duty and compare with what was measured.",
        examples=(
            "pierburg replay run.mcap -o replayed",
            "pierburg replay run.mcap --model model.yaml -o replayed",
        ),
    ),
    "diagnose": Command(
        "Locate a mismatch, name the missing physics, model it, show the fit improve.",
        examples=(
            "pierburg diagnose run.mcap",
            "pierburg diagnose a.mcap b.mcap --actuator my.yaml -o d",
            "pierburg diagnose run.mcap --simulation sim.mcap -o out",
            "pierburg diagnose run.mcap -o out --json > found.json",
        ),
    ),
    "fleet": Command(
        "Many recordings of many actuators: how each ages, and which to look at first.",
        examples=(
            "pierburg fleet recordings -o fleet",
            "pierburg fleet runs --pattern '{unit}_{date}.mcap' -o f",
            "pierburg fleet runs --limit armature_resistance=5 -o f",
            "pierburg fleet runs.csv --scheduler tcp://head:8786 -o f",
        ),
    ),
    "inspect": Command(
        "What is in a recording: topics, rates, ranges, losses, clocks, what each could be.",
        examples=(
            "pierburg inspect run.mcap",
            "pierburg inspect run.mcap --write-signals signals.yaml",
            "pierburg inspect run.mcap --json",
        ),
    ),
    "export": Command(
        "The corrected model for MuJoCo, URDF, SDF, Modelica or JSON, and what each cannot hold.",
        examples=("pierburg export model.yaml --to mujoco -o valve.xml",),
    ),
    "actuator": Command(
        "Describe an actuator; say what is implausible about a description.",
        examples=(
            "pierburg actuator new mine.yaml",
            "pierburg actuator new my.yaml --from-recording run.mcap",
            "pierburg actuator check pierburg",
        ),
    ),
    "recover": Command(
        "Make a cut recording whole for every reader.",
        examples=("pierburg recover run.mcap", "pierburg recover run.mcap -o whole.mcap"),
    ),
    "prove": Command(
        "Seeded blind trials of the diagnosis; known effects put into your own recordings.",
        examples=(
            "pierburg prove --trials 1 -o proof",
            "pierburg prove --only consistent --only drift -o proof",
            "pierburg prove --real bench/ --actuator my.yaml -o proof",
            "pierburg prove --real bench --model my.yaml -o proof",
        ),
    ),
    "tune": Command(
        "PIFLC gains and sets for a corrected model, or for a set of plants.",
        examples=(
            "pierburg tune --model model.yaml -o controller.yaml",
            "pierburg tune --overshoot 1 --settling 3 -o soft.yaml",
        ),
    ),
}


def application(called: str | None = None) -> typer.Typer:
    """The command line, with the function of the `called` command and summaries in place of the others."""
    settings = {"help_option_names": ["-h", "--help"], "max_content_width": HELP_WIDTH}
    app = typer.Typer(name="pierburg", pretty_exceptions_enable=False, rich_markup_mode=None, context_settings=settings)
    app.callback()(options)
    for name, command in COMMANDS.items():
        function = command_of(name) if name == called else summary_only
        registered = app.command(
            name, short_help=command.summary, epilog=command.epilog, context_settings=command.settings
        )
        registered(function)
    return app


def command_of(name: str) -> Callable[..., None]:
    """The function of a command, with the options that all commands have."""
    from pierburg_ros.cli.options.common import with_common

    return with_common(getattr(import_module(f"pierburg_ros.cli.{name}"), name))


def summary_only() -> None:
    """Stands for a command that is listed and not called."""


def print_version(wanted: bool) -> None:
    """Print the installed version and stop, if `wanted`."""
    if wanted:
        from importlib.metadata import version as installed_version

        typer.echo(f"pierburg_ros {installed_version('pierburg_ros')}")
        raise typer.Exit


VERSION = typer.Option("--version", callback=print_version, is_eager=True, help="Print the version and stop.")


def options(version: Annotated[bool, VERSION] = False) -> None:
    """Simulate, control, record and diagnose the Pierburg mechatronic actuator."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; what a person gave wrongly ends as one line on stderr and exit status 2."""
    show_log()
    given = spread(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    typed = " ".join(os.environ.get(name, "") for name in COMPLETING).split()
    called = next((argument for argument in (*typed, *given) if argument in COMMANDS), None)
    try:
        refuse_empty(given)
        with terminable():
            status = application(called)(given, prog_name="pierburg", standalone_mode=False)
    except InputError as error:
        refuse(str(error))
    except OSError as error:
        if error.filename is None:
            raise
        refuse(f"{error.filename}: {error.strerror}.")
    except KeyboardInterrupt:
        status = INTERRUPTED
    except Terminated:
        status = TERMINATED
    except Exception as error:
        refuse(usage(error, f"pierburg {called}" if called else "pierburg"))
    if status in SIGNALS:
        print(f"pierburg: {SIGNALS[status]}.", file=sys.stderr)
    raise SystemExit(status if isinstance(status, int) else 0)


def spread(arguments: Sequence[str]) -> list[str]:
    """The arguments with an option of `SPREAD` repeated before each of its values.

    `--simulation a b` is one of a and one of b. Click has no option with several values.
    """
    found: list[str] = []
    option = ""
    for argument in arguments:
        if argument.startswith("-"):
            option = next((name for name in SPREAD if argument.partition("=")[0] == name), "")
        elif option and found[-1] != option:
            found.append(option)
        found.append(argument)
    return found


def refuse_empty(arguments: Sequence[str]) -> None:
    """Raise InputError for an argument without a character, which as a path would be the present folder."""
    for before, argument in zip(["pierburg", *arguments], arguments, strict=False):
        option = argument.partition("=")[0]
        if not argument or (option.startswith("--") and argument == f"{option}="):
            raise InputError(f"Found nothing in the argument behind {option or before}, expected a value. Give one.")


def show_log() -> None:
    """Show on stderr what the package logs, such as a wait for the compiler; it is silent as a library."""
    log = logging.getLogger("pierburg_ros")
    if not log.handlers:
        log.addHandler(logging.StreamHandler())
        log.setLevel(logging.INFO)
