"""A model in the format of another simulator."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pierburg_ros.export import Exported
from pierburg_ros.export import export as exporting
from pierburg_ros.intake import path_of
from pierburg_ros.library.output import write_whole
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Export:
    """The text of the file, and in words what of the model it lacks and what it holds in another way."""

    text: str
    left_out: tuple[str, ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"Export({len(self.text)} characters, {len(self.left_out)} numbers left out)"

    @staticmethod
    def of(exported: Exported) -> Export:
        """What an export says, in words."""
        return Export(exported.text, tuple(each.text for each in exported.left_out), exported.notes)

    def write(self, path: str | Path) -> None:
        """Write the file, whole or not at all."""
        write_whole(path_of(path, "the path of a file"), self.text)


def export(model: Model, to: str) -> Export:
    """`model` for another simulator: `to` is mujoco, urdf, sdf, modelica or json. InputError where there is no such."""
    return Export.of(exporting(model, to))
