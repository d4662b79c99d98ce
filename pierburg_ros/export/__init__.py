"""The corrected model for other simulators: one file a format, and a list of what a format cannot hold."""

from __future__ import annotations

from collections.abc import Callable

from pierburg_ros.errors import InputError, near
from pierburg_ros.export.contents import Contents, Exported, LeftOut
from pierburg_ros.export.json_document import json_document
from pierburg_ros.export.modelica import modelica
from pierburg_ros.export.mujoco import mujoco
from pierburg_ros.export.sdf import sdf
from pierburg_ros.export.urdf import urdf
from pierburg_ros.plant import Model

FORMATS: dict[str, Callable[[Contents], str]] = {
    "mujoco": mujoco,
    "urdf": urdf,
    "sdf": sdf,
    "modelica": modelica,
    "json": json_document,
}
"""What writes each format."""

__all__ = ["FORMATS", "Exported", "LeftOut", "export"]


def export(model: Model, to: str) -> Exported:
    """`model` in a format of `FORMATS`; InputError where there is none of that name."""
    if to not in FORMATS:
        raise InputError(
            f"There is no format {to}; expected {', '.join(FORMATS)}.{near(to, FORMATS)} Choose one of those."
        )
    contents = Contents(model)
    return contents.exported(FORMATS[to](contents))
