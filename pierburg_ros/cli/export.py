"""`pierburg export`: the corrected model for other simulators."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.models import notes
from pierburg_ros.errors import InputError

ToOption = Annotated[str, typer.Option("--to", help="mujoco, urdf, sdf, modelica or json.")]


def export(
    model: Annotated[Path, typer.Argument(help="Model file, as `diagnose` and `identify` write it.")],
    to: ToOption,
    output: Annotated[Path, typer.Option(help="File to write.")],
) -> dict[str, object]:
    """Write a model for another simulator, and say what its format cannot hold."""
    refuse_folder(output)
    from pierburg_ros.library.model import Model

    exported = Model.read(model).export(to)
    exported.write(output)
    console = terminal()
    said = [*notes(model), *exported.notes]
    for note in said:
        console.print(note, soft_wrap=True, markup=False)
    if exported.left_out:
        console.print(f"Left out, since {to} has no place for it (the file lists it too):")
        for each in exported.left_out:
            console.print(f"  {each}", soft_wrap=True, markup=False)
    console.print(f"Written to {output}", soft_wrap=True, markup=False)
    return {"file": str(output), "format": to, "notes": said, "left_out": exported.left_out}


def refuse_folder(output: Path) -> None:
    """Raise InputError where the output cannot become a file."""
    if output.is_dir():
        raise InputError(f"{output} is a folder, expected a file to write. Add a name, e.g. {output / 'model.xml'}.")
    present = next(path for path in output.absolute().parents if path.exists())
    if not present.is_dir() or not os.access(present, os.W_OK | os.X_OK):
        raise InputError(f"{output} cannot be written, since {present} cannot. Choose another --output.")
