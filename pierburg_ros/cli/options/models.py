"""The options with which a command names the model it simulates."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.actuators.description import SHIPPED
from pierburg_ros.library import model as library
from pierburg_ros.library.model import Model

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
    """The model of the file `model`, or the nominal one of `actuator`; of the Pierburg valve where neither is named."""
    return library.chosen_model(model, actuator if actuator or model else DEFAULT)
