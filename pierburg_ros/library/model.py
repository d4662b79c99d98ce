"""The model as the library's users meet it: read, changed, written."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

from pierburg_ros import plant
from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.intake import path_of
from pierburg_ros.library import exporting
from pierburg_ros.library.exporting import Export
from pierburg_ros.library.output import write_whole
from pierburg_ros.plant.model_file import read_model


class Model(plant.Model):
    """An actuator, the values of its parameters by dotted name, and the effects that act.

    `values` has every name, as in `armature_resistance` [ohm] or `effect.parameter`; those of absent effects are
    0. A model never changes: `with_values` gives another one, `write(path)` writes a model file.

        worn = pr.Model.nominal("pierburg").with_values({"armature_resistance": 4.7})
    """

    def __repr__(self) -> str:
        content = self.as_mapping()
        changed = [f"{name} {value:.6g}" for name, value in content["parameters"].items()]
        shape = ["residual torque"] if self.residual_torque is not None else []
        return f"Model({', '.join([self.actuator.name, *changed, *self.active_effects, *shape])})"

    def __hash__(self) -> int:
        return hash((self.actuator.name, tuple(sorted(self.values.items()))))

    @staticmethod
    def nominal(actuator: Actuator | str | Path = "pierburg") -> Model:
        """An actuator as described: a shipped name (pierburg, xl330) or the path of a description."""
        described = actuator if isinstance(actuator, Actuator) else read_actuator(actuator)
        return Model.of(plant.Model.nominal(described))

    @staticmethod
    def read(source: str | Path | Mapping[str, Any], actuator: Actuator | str | Path | None = None) -> Model:
        """The model in a model file, or of its content as a mapping; InputError names the line that is wrong.

        `actuator` takes the place of the one that the file names.
        """
        described = read_actuator(actuator) if isinstance(actuator, (str, Path)) else actuator
        return Model.of(read_model(source, described))

    @staticmethod
    def of(model: plant.Model) -> Model:
        """`model` with what this class adds."""
        return Model(model.actuator, model.values, model.residual_torque)

    def export(self, to: str) -> Export:
        """The model for another simulator: `to` is mujoco, urdf, sdf, modelica or json; InputError where it is none.

        What the format cannot hold stands in the file as a comment, and in `left_out`: effect, parameter, value.

            exported = pr.Model.read("results/diagnosis/model.yaml").export("mujoco")
            exported.write("valve.xml")
            print(exported.left_out)
        """
        return exporting.export(self, to)

    def with_values(self, changes: Mapping[str, float]) -> Model:
        """The model with some values changed; InputError where a name is unknown or a value not allowed."""
        return Model.of(super().with_values(changes))

    def with_residual(self, residual_torque: Mapping[str, Any] | None) -> Model:
        """The model with a residual torque: `angle` [rad], `velocity` [rad/s], `torque` [N.m] on their grid."""
        return Model.of(super().with_residual(residual_torque))

    def write(self, path: str | Path) -> None:
        """Write the model file, whole or not at all; its folder is made where it is missing."""
        write_whole(path_of(path, "the path of a file"), self.text())


ModelLike: TypeAlias = plant.Model | str | Path
"""A model, or the path of a model file."""
ActuatorLike: TypeAlias = Actuator | str | Path
"""An actuator, a shipped name, or the path of a description."""


def chosen_model(model: ModelLike | None, actuator: ActuatorLike | None = None) -> Model:
    """The model given, or the nominal one of `actuator`; both: the file's values for its actuator, described anew."""
    if isinstance(model, plant.Model):
        if actuator is not None:
            raise InputError("Found a model and an actuator, and a model has its actuator. Leave the actuator out.")
        return Model.of(model)
    if model is not None:
        found = Model.read(model)
        if actuator is None:
            return found
        own, described = found.actuator.name, Model.nominal(actuator).actuator
        if own != described.name:
            raise InputError(
                f"{model} is a model of {own} and --actuator found {described.name}, expected a description of {own}."
                " A model has its actuator: leave --actuator out."
            )
        return Model.read(model, described)
    if actuator is None:
        raise InputError("Found no model, expected one or the path of its file. Give pr.Model.nominal('pierburg').")
    return Model.nominal(actuator)
