"""`pierburg inspect`: what is in a recording, and what of it the other commands read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from pierburg_ros.cli.recordings import TimeOption, TopicOption, topics_of
from pierburg_ros.recording.inspect import Inspection, TopicContent
from pierburg_ros.recording.inspect import inspect as inspected

SPANS = 5
"""Stretches that are listed; the others are counted, and all are in the JSON."""


def inspect(
    recording: Annotated[Path, typer.Argument(help="MCAP, rosbag2 directory or CSV.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> None:
    """Show the topics of a recording: types, rates, ranges, losses, clocks, and which signal each is read as."""
    found = inspected(recording, time=time, topics=topics_of(topic))
    if as_json:
        print(json.dumps(found.as_mapping(), indent=1, allow_nan=False))
        return
    console = Console(highlight=False, soft_wrap=True, markup=False)
    if found.recording is not None and found.recording.warning:
        console.print(found.recording.warning)
    console.print(table(found))
    console.print(read_as(found))


def table(found: Inspection) -> Table:
    """One row a topic."""
    shown = Table(title=Text(found.name))
    for heading in ("topic and type", "messages", "range", "missing", "clocks", "read as"):
        shown.add_column(heading)
    for topic in found.topics:
        shown.add_row(*(Text(cell) for cell in row(topic)))
    return shown


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
