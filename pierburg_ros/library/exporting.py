"""A model in the format of another simulator."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pierburg_ros.export import Exported
from pierburg_ros.export import export as exporting
from pierburg_ros.library.model import ModelLike, chosen_model
from pierburg_ros.library.output import write_whole


@dataclass(frozen=True)
class Export:
    """The text of the file, and in words what of the model it lacks and what it holds in another way."""

    text: str
    left_out: tuple[str, ...]
    notes: tuple[str, ...]

    @staticmethod
    def of(exported: Exported) -> Export:
        """What an export says, in words."""
        return Export(exported.text, tuple(each.text for each in exported.left_out), exported.notes)

    def write(self, path: str | Path) -> None:
        """Write the file, whole or not at all."""
        write_whole(Path(path), self.text)


def export(model: ModelLike, to: str) -> Export:
    """A model for another simulator: `to` is mujoco, urdf, sdf, modelica or json.

    What the format cannot hold stands in the file as a comment, and in `left_out`: effect, parameter, value. InputError
    where the model or the format cannot be used.

        exported = pr.export("results/diagnosis/model.yaml", to="mujoco")
        exported.write("valve.xml")
        print(exported.left_out)
    """
    return Export.of(exporting(chosen_model(model), to))
