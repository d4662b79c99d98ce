"""The options with which every command that reads recordings names topics and a clock."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from pierburg_ros.errors import InputError

if TYPE_CHECKING:
    from pierburg_ros.plant import Model
    from pierburg_ros.recording import Recording

TopicOption = Annotated[
    list[str] | None,
    typer.Option(
        "--topic",
        metavar="SIGNAL=NAME",
        help="Name the topic (or CSV column) of a signal, e.g. duty=/bench/pwm. May be given several times.",
    ),
]
SignalsOption = Annotated[
    Path | None,
    typer.Option(
        "--signals",
        metavar="FILE",
        help="Signal map (YAML): which topic and field, or column, is which signal. 'inspect' writes one.",
    ),
]
TimeOption = Annotated[
    str | None,
    typer.Option(
        "--time",
        metavar="{stamp,clock,publish,log}",
        help="Clock of the recording; default: the first of these that it has.",
    ),
]

ExactOption = Annotated[
    list[str] | None,
    typer.Option(
        "--exact",
        metavar="SIGNAL",
        help="This signal is what it is read as, e.g. duty: look for no fault of it. May be given several times.",
    ),
]

ResultsOption = Annotated[
    Path | None,
    typer.Option(show_default="results/COMMAND/RECORDING", help="Folder for the results."),
]


def results_folder(output: Path | None, command: str, recording: Path) -> Path:
    """The folder that was named, else that of the `command` and its first recording."""
    return output or Path("results") / command / recording.absolute().stem


def topics_of(options: Sequence[str] | None) -> dict[str, str]:
    """{"duty": "/bench/pwm"} from ["duty=/bench/pwm"]."""
    topics: dict[str, str] = {}
    for option in options or ():
        signal, equals, name = option.partition("=")
        if not (signal and equals and name):
            raise InputError(f"--topic found {option!r}, expected SIGNAL=NAME. Write --topic duty=/bench/pwm.")
        topics[signal] = name
    return topics


def losses_first(console: Console, recordings: Sequence[Recording]) -> None:
    """Print, before anything else, which of the recordings lack messages; nothing where none does."""
    for recording in recordings:
        if recording.warning:
            console.print(f"{recording.name}: {recording.warning}", soft_wrap=True)


def faults_first(console: Console, recordings: Sequence[Recording], nominal: Model) -> None:
    """Print which signals of the recordings are not what they are read as, and what mends them; nothing of others."""
    from pierburg_ros.audit import audit

    for fault in audit(recordings, nominal):
        console.print(f"Warning: {fault}", soft_wrap=True, markup=False)
