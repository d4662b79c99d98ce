"""The options with which every command that reads recordings names topics and a clock."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from pierburg_ros.errors import InputError

TopicOption = Annotated[
    list[str] | None,
    typer.Option(
        "--topic",
        metavar="SIGNAL=NAME",
        help="Name the topic (or CSV column) of a signal, e.g. duty=/bench/pwm. May be given several times.",
    ),
]
TimeOption = Annotated[
    str | None,
    typer.Option(
        "--time",
        metavar="{stamp,clock,publish,log}",
        help="Choose the clock of the recording; by default the first of these that it has.",
    ),
]


def topics_of(options: Sequence[str] | None) -> dict[str, str]:
    """{"duty": "/bench/pwm"} from ["duty=/bench/pwm"]."""
    topics: dict[str, str] = {}
    for option in options or ():
        signal, equals, name = option.partition("=")
        if not (signal and equals and name):
            raise InputError(f"--topic found {option!r}, expected SIGNAL=NAME. Write --topic duty=/bench/pwm.")
        topics[signal] = name
    return topics
