"""The `pierburg` command and its table of commands.

A command is a function named like its file, `cli/<name>.py`. Only the one that is called is imported, so that
listing the commands loads and compiles nothing.
"""

from __future__ import annotations

import logging
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import version as installed_version
from typing import Annotated, Any, NoReturn

import typer

from pierburg_ros.errors import InputError, one_line

SPREAD = ("--simulation",)
"""Options that take every value up to the next option."""
INTERRUPTED, TERMINATED = 128 + signal.SIGINT, 128 + signal.SIGTERM
SIGNALS = {INTERRUPTED: "interrupted", TERMINATED: "terminated"}
"""Exit statuses of a run that a signal has ended, as shells count them, and the line that says so."""


@dataclass(frozen=True)
class Command:
    """What the list of commands says about one, without importing it."""

    summary: str
    settings: dict[str, Any] = field(default_factory=dict)


COMMANDS = {
    "demo": Command("The whole story on a fresh machine: record, replay and diagnose a concealed effect."),
    "run": Command(
        "Start one of the nodes: plant, controller or recorder.",
        {"allow_extra_args": True, "ignore_unknown_options": True},
    ),
    "simulate": Command("Simulate the open or the closed loop to MCAP, without a ROS graph."),
    "experiment": Command("Excitation recipes, and the sequence that best separates two explanations."),
    "identify": Command("Static characteristic, step response and parameters from recordings."),
    "replay": Command("Simulate a recorded duty and compare with what was measured."),
    "diagnose": Command("Locate a mismatch, name the missing physics, model it, show the fit improve."),
    "fleet": Command("Many recordings of many actuators: how each ages, and which to look at first."),
    "inspect": Command("What is in a recording: topics, rates, ranges, losses, clocks, what each could be."),
    "export": Command("The corrected model for MuJoCo, URDF, SDF, Modelica or JSON, and what each cannot hold."),
    "actuator": Command("Describe an actuator; say what is implausible about a description."),
    "recover": Command("Make a cut recording whole for every reader."),
    "prove": Command("Seeded blind trials of the diagnosis."),
    "tune": Command("PIFLC gains and sets for a stated goal over a set of plants."),
}


def application(called: str | None = None) -> typer.Typer:
    """The command line, with the function of the `called` command and summaries in place of the others."""
    app = typer.Typer(name="pierburg", add_completion=False, pretty_exceptions_enable=False)
    app.callback()(options)
    for name, command in COMMANDS.items():
        is_called = name == called
        function = getattr(import_module(f"pierburg_ros.cli.{name}"), name) if is_called else summary_only
        summary = None if is_called else command.summary
        app.command(name, help=summary, context_settings=command.settings)(function)
    return app


def summary_only() -> None:
    """Stands for a command that is listed and not called."""


def print_version(wanted: bool) -> None:
    """Print the installed version and stop, if `wanted`."""
    if wanted:
        typer.echo(f"pierburg_ros {installed_version('pierburg_ros')}")
        raise typer.Exit


VERSION = typer.Option(callback=print_version, is_eager=True, help="Print the version and stop.")


def options(version: Annotated[bool, VERSION] = False) -> None:
    """Simulate, control, record and diagnose the Pierburg mechatronic actuator."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; what a person gave wrongly ends as one line on stderr and exit status 2."""
    show_log()
    given = spread(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    called = next((argument for argument in given if argument in COMMANDS), None)
    try:
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
        # Typer keeps its usage errors private; they are the ones that can format themselves.
        if not hasattr(error, "format_message"):
            raise
        refuse(f"{error.format_message()} See 'pierburg {called or ''} --help'.".replace("  ", " "))
    if status in SIGNALS:
        print(f"pierburg: {SIGNALS[status]}.", file=sys.stderr)
    raise SystemExit(status if isinstance(status, int) else 0)


class Terminated(BaseException):
    """SIGTERM has come: everything that is open is closed and cleared on the way out, as after Ctrl-C."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM end the block as an exception does; its default would leave what is half done."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def end(*_: object) -> None:
        raise Terminated

    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def spread(arguments: Sequence[str]) -> list[str]:
    """The arguments with an option of `SPREAD` repeated before each of its values: --simulation a b is one of a and one
    of b. Click has no option with several values."""
    found: list[str] = []
    option = ""
    for argument in arguments:
        if argument.startswith("-"):
            option = next((name for name in SPREAD if argument.partition("=")[0] == name), "")
        elif option and found[-1] != option:
            found.append(option)
        found.append(argument)
    return found


def show_log() -> None:
    """Show on stderr what the package logs, such as a wait for the compiler; it is silent as a library."""
    log = logging.getLogger("pierburg_ros")
    if not log.handlers:
        log.addHandler(logging.StreamHandler())
        log.setLevel(logging.INFO)


def refuse(reason: str) -> NoReturn:
    """Print `reason` as one line on stderr and end with exit status 2."""
    print("pierburg:", one_line(reason), file=sys.stderr)
    raise SystemExit(2)


def standalone(name: str) -> Callable[[], None]:
    """The command `name` as an executable of its own, as `ros2 run pierburg_ros NAME` starts it."""

    def run() -> None:
        main([name, *sys.argv[1:]])

    return run


demo = standalone("demo")
simulate = standalone("simulate")
experiment = standalone("experiment")
identify = standalone("identify")
replay = standalone("replay")
diagnose = standalone("diagnose")
fleet = standalone("fleet")
inspect = standalone("inspect")
export = standalone("export")
actuator = standalone("actuator")
recover = standalone("recover")
prove = standalone("prove")
tune = standalone("tune")
