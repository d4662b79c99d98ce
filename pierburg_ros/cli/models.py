"""The options with which a command names the model it simulates."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.errors import InputError
from pierburg_ros.library import model as library
from pierburg_ros.library.model import Model

ModelOption = Annotated[Path | None, typer.Option("--model", help="Model file to simulate with.")]
ActuatorOption = Annotated[
    str | None, typer.Option(help="Actuator to simulate with: pierburg, xl330 or a file of your own.")
]


def chosen_model(model: Path | None, actuator: str | None) -> Model:
    """The model of the file `model`, or the nominal one of `actuator`."""
    if model is None and actuator is None:
        raise InputError("Found neither --model nor --actuator, expected one. Add --actuator pierburg.")
    return library.chosen_model(model, actuator)


def chosen_or_valve(model: Path | None, actuator: str | None) -> Model:
    """`chosen_model`; the nominal Pierburg valve where neither is named."""
    return library.chosen_model(model, actuator if actuator or model else "pierburg")
