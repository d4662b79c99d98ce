"""`pierburg inspect`: what is in a recording, and what of it the other commands read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.recordings import SignalsOption, TimeOption, TopicOption, faults_first, topics_of
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import refuse_no_file, write_whole
from pierburg_ros.pages.listing import Listing

if TYPE_CHECKING:
    from pierburg_ros.recording.inspection import Inspection, TopicContent

FIELDS = 12
"""Numbers of a topic that are listed; all are in the JSON."""
SPANS = 5
"""Stretches that are listed; the others are counted, and all are in the JSON."""


def inspect(
    recording: Annotated[Path, typer.Argument(help="MCAP, rosbag2 directory or CSV.")],
    write_signals: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a signal map of what was guessed, to edit.")
    ] = None,
    actuator: Annotated[str | None, typer.Option(help="Hold the signals against this actuator.")] = None,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> dict[str, Any]:
    """Show the topics of a recording: types, rates, ranges, losses, clocks, what each is read as and could be.

    --write-signals FILE writes a signal map with these guesses, which every command takes with --signals.
    """
    if write_signals is not None:
        refuse_present(write_signals)
    from pierburg_ros.recording.inspection import inspect as inspected

    found = inspected(recording, time=time, topics=topics_of(topic), signals=signals)
    if write_signals is not None:
        write_whole(write_signals, found.signals)
    shown(terminal(), recording, found, actuator, write_signals, mapped=signals is not None)
    return found.as_mapping()


def shown(
    console: Console, recording: Path, found: Inspection, actuator: str | None, written: Path | None, mapped: bool
) -> None:
    """Print what was found, what it is read as, and what to do next."""
    if found.recording is not None and found.recording.warning:
        console.print(found.recording.warning, soft_wrap=True)
    console.print(table(found))
    console.print("\n".join(numbers(found, mapped)), soft_wrap=True)
    console.print(read_as(found), soft_wrap=True)
    if found.recording is not None and actuator is not None:
        from pierburg_ros.actuators import read_actuator
        from pierburg_ros.plant import Model

        faults_first(console, [found.recording], Model.nominal(read_actuator(actuator)))
    if written is not None:
        console.print(
            f"{written}: a signal map of these guesses. Check it, then give it with --signals.", soft_wrap=True
        )
    elif found.recording is None:
        advice = f"Write a signal map to edit: pierburg inspect {recording} --write-signals signals.yaml"
        console.print(advice, soft_wrap=True)


def refuse_present(path: Path) -> None:
    """Raise InputError where a signal map cannot be written; one that is there, edited perhaps, stays."""
    refuse_no_file(path)
    if path.exists():
        raise InputError(f"{path} exists, expected a new name for the signal map. Choose another.")


def table(found: Inspection) -> Listing:
    """One row a topic."""
    headings = ("topic and type", "messages", "range", "missing", "clocks", "read as")
    return Listing(headings, [row(topic) for topic in found.topics], found.name)


def row(topic: TopicContent) -> tuple[str, ...]:
    """The cells of one topic."""
    pauses = f"{len(topic.pauses)} pauses" if topic.pauses else "no pause"
    return (
        f"{topic.name}\n{topic.type}",
        str(topic.count) + ("" if topic.rate is None else f"\n{topic.rate:.1f} Hz"),
        "" if topic.minimum is None else f"{topic.minimum:.4g}\n{topic.maximum:.4g}",
        pauses if topic.lost is None else str(topic.lost),
        "\n".join(topic.clocks),
        topic.read_as or "",
    )


def numbers(found: Inspection, mapped: bool) -> Iterator[str]:
    """A line for each number of each topic: its path, its range, what it could be; none for what a map has settled."""
    for topic in found.topics:
        if mapped and topic.read_as:
            continue
        for field in topic.fields[:FIELDS]:
            limits = "no number" if field.minimum is None else f"{field.minimum:.4g} to {field.maximum:.4g}"
            yield f"{topic.name} {field.path}".rstrip() + f"  {field.could_be or limits}"
        if len(topic.fields) > FIELDS:
            yield f"{topic.name}: {len(topic.fields) - FIELDS} more numbers, listed with --json"


def read_as(found: Inspection) -> str:
    """What the other commands make of the file."""
    recording = found.recording
    if recording is None:
        return f"Not read as a recording: {found.problem}"
    text = (
        f"Read as {recording.quantity.replace('_', ' ')} [{recording.unit}], {recording.time.size} samples over"
        f" {recording.duration:.3f} s, times: {recording.time_source}."
    )
    spans = [f"{start:.3f} to {end:.3f} s" for start, end in recording.unknown_input]
    if spans:
        more = f" and {len(spans) - SPANS} more" if len(spans) > SPANS else ""
        text += f" Duty unknown: {', '.join(spans[:SPANS])}{more}."
    return text
