"""`pierburg actuator new` and `check`: describe an actuator, and say what is implausible about a description."""

from __future__ import annotations

import math
import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import JobsOption
from pierburg_ros.cli.options.recordings import SignalsOption, TimeOption, TopicOption, topics_of
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import refuse_no_file, write_whole
from pierburg_ros.pages.listing import Listing
from pierburg_ros.pages.numbers import number, unit

if TYPE_CHECKING:
    from pierburg_ros.actuators import Actuator
    from pierburg_ros.identification.description.questions import Question


class Action(str, Enum):
    """What to do with a description."""

    new = "new"
    check = "check"


def actuator(
    action: Annotated[Action, typer.Argument(help="new: write a description. check: say what is implausible.")],
    file: Annotated[Path, typer.Argument(help="The description (YAML); to check also the name of a shipped one.")],
    from_recording: Annotated[Path | None, typer.Option(help="Start from what this recording tells.")] = None,
    like: Annotated[
        str | None, typer.Option(help="Actuator that gives the numbers which the recording does not tell.")
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the file if it is there.")] = False,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
    jobs: JobsOption = None,
) -> dict[str, object]:
    """Describe an actuator, from answers or from a recording, or check a description.

    `new` asks what it needs, or identifies it from a recording and marks what it guessed.
    `check` derives speeds, torques and times, names numbers that look like slips, and says which numbers no recording
    of its signals can tell.
    """
    console = terminal()
    if action is Action.check:
        return check(console, file)
    if file.exists() and not overwrite:
        raise InputError(f"{file} is there already, expected a new file. Name another one, or add --overwrite.")
    refuse_no_file(file)
    from pierburg_ros.actuators import read_actuator
    from pierburg_ros.actuators.writing import description_text
    from pierburg_ros.identification.description.questions import answered

    if from_recording is None:
        content = answered(asked)
    else:
        from pierburg_ros.identification.description.recorded import alike, identified
        from pierburg_ros.library.reading import read

        start = None if like is None else read_actuator(like)
        recording = read(from_recording, time=time, topics=topics_of(topic), signals=signals, actuator=start)
        if start is None:
            start = read_actuator(alike(recording))
            console.print(begun_from(start), soft_wrap=True)
        content = identified(recording, start, file.stem, jobs)
    text = description_text(content, file.name)
    write_whole(file, text)
    console.print(f"Wrote {file}. Check it: pierburg actuator check {file}", soft_wrap=True)
    return {"file": str(file), "description": text}


def begun_from(start: Actuator) -> str:
    """What a person should know who named no actuator to start from."""
    load = {"spring": "a spring", "pendulum": "a pendulum", "none": "nothing"}[start.load]
    stops = "with" if start.has_stops else "without"
    return (
        f"Started from {start.name}, which is loaded by {load} and {stops} stops. If yours is of another kind or size,"
        " describe it roughly and name that with --like FILE."
    )


def asked(question: Question, problem: str) -> str:
    """A person's answer to a question; InputError where nobody is there to answer, or to answer again."""
    if problem and not sys.stdin.isatty():
        raise InputError(problem)
    if problem:
        typer.echo(problem, err=True)
    choices = f" ({', '.join(question.choices)})" if question.choices else ""
    try:
        return str(typer.prompt(question.text + choices, default=question.default, show_default=bool(question.default)))
    except typer.Abort:
        raise InputError(
            f"Found no answer to {question.text.strip()!r}, expected one. Answer at a terminal, or use"
            " --from-recording."
        ) from None


def check(console: Console, file: Path) -> dict[str, object]:
    """Print and give derived numbers, remarks, and what a standard excitation of the description would tell."""
    from pierburg_ros.actuators import read_actuator
    from pierburg_ros.identification.description.derived import derived
    from pierburg_ros.identification.description.slips import remarks
    from pierburg_ros.identification.description.told import told
    from pierburg_ros.plant import Model

    described = read_actuator(str(file))
    numbers, found = derived(described), remarks(described)
    rows = [(each.name, number(each.value) + unit(each.unit), "yes" if each.plausible else "NO") for each in numbers]
    console.print(Listing(("number", "value", "plausible"), rows, f"{described.title}: what the numbers imply"))
    lines = [f"{remark.about}: {remark.what}" for remark in found] or ["Nothing is implausible."]
    console.print("\n".join(lines), soft_wrap=True, markup=False)
    signals = f"{described.input} and {described.quantity.replace('_', ' ')}"
    findings = told(Model.nominal(described))
    reasons = [f"  {name}: {finding.reason}" for name, finding in findings.items()]
    console.print(f"What a recording of {signals} tells:", *reasons, sep="\n", soft_wrap=True, markup=False)
    return {
        "actuator": described.name,
        "numbers": [
            {"name": each.name, "value": finite(each.value), "unit": each.unit, "plausible": each.plausible}
            for each in numbers
        ],
        "remarks": [{"about": remark.about, "what": remark.what} for remark in found],
        "told": {name: finding.reason for name, finding in findings.items()},
    }


def finite(value: float) -> float | None:
    """The value, or None where JSON has none."""
    return value if math.isfinite(value) else None
