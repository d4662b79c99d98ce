"""`pierburg export`: the corrected model for other simulators."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.models import notes
from pierburg_ros.library.output import refuse_no_file

ToOption = Annotated[str, typer.Option("--to", help="mujoco, urdf, sdf, modelica or json.")]


def export(
    model: Annotated[Path, typer.Argument(help="Model file, as `diagnose` and `identify` write it.")],
    to: ToOption,
    output: Annotated[Path, typer.Option(help="File to write.")],
) -> dict[str, object]:
    """Write a model for another simulator, and say what its format cannot hold."""
    refuse_no_file(output)
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
