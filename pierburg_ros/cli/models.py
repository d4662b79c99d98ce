"""The options with which a command names the model it simulates."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model, read_model

ModelOption = Annotated[Path | None, typer.Option("--model", help="Model file to simulate with.")]
ActuatorOption = Annotated[
    str | None, typer.Option(help="Actuator to simulate with: pierburg, xl330 or a file of your own.")
]


def chosen_model(model: Path | None, actuator: str | None) -> Model:
    """The model of the file `model`, or the nominal one of `actuator`."""
    described = read_actuator(actuator) if actuator is not None else None
    if model is not None:
        return read_model(model, described)
    if described is None:
        raise InputError("Found neither --model nor --actuator, expected one. Add --actuator pierburg.")
    return Model.nominal(described)
