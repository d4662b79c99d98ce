"""The options with which a command names the model it simulates."""

from __future__ import annotations

from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal

if TYPE_CHECKING:
    from pierburg_ros.library.model import Model

SHIPPED = ("pierburg", "xl330", "ak80", "odrive")
"""Actuators that come with the package, as `actuators.SHIPPED`, which takes a second to load."""
DEFAULT = "pierburg"
"""The actuator where none is named, for every command."""
ModelOption = Annotated[Path | None, typer.Option("--model", help="Model file to start from.")]
ActuatorOption = Annotated[
    str | None,
    typer.Option(
        help=f"Actuator: {', '.join(SHIPPED)}, or a description of your own; default: that of --model, else {DEFAULT}."
    ),
]


def chosen_model(model: Path | None, actuator: str | None) -> Model:
    """The model of the file `model`, or the nominal one of `actuator`; of the Pierburg valve where neither is named.

    Prints what the file says of itself, as that its diagnosis has concluded nothing.
    """
    from pierburg_ros.library import model as library

    chosen = library.chosen_model(model, actuator if actuator or model else DEFAULT)
    for note in notes(model):
        terminal().print(f"{model}: {note}", soft_wrap=True)
    return chosen


def notes(model: Path | None) -> list[str]:
    """What a model file says of itself: the lines of comment that it begins with."""
    if model is None:
        return []
    lines = model.read_text(encoding="utf-8").splitlines()
    return [line.lstrip("# ") for line in takewhile(lambda line: line.startswith("#"), lines)]
