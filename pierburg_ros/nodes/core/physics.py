"""What the plant node asks of a simulator, and the two that answer: the exact one and the textbook one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import DECLARED
from pierburg_ros.errors import InputError
from pierburg_ros.parameter import Parameter as Declaration
from pierburg_ros.plant import Model, Plant, read_model

if TYPE_CHECKING:  # compiled only where it is asked for
    from pierburg_ros.proof.formulation import TextbookPlant


class Physics:
    """A stepped simulator whose parameters follow those of the node."""

    def __init__(self, model: Model, formulation: str, noise: float, seed: int) -> None:
        self._model = model
        self._textbook = formulation == "textbook"
        self._plant = self._made(noise, seed)
        self._plant.advance(0.0, 0.0)
        self._plant.reset()

    def declarations(self) -> list[Declaration]:
        """Every base parameter and every effect's parameter, with the model's values."""
        return [declaration(self._model, name) for name in self._model.values]

    @property
    def values(self) -> Mapping[str, float]:
        """The parameter values in force."""
        return self._model.values

    def has(self, name: str) -> bool:
        """Whether `name` is a parameter of the physics."""
        return name in self._model.values

    def change(self, values: Mapping[str, float]) -> None:
        """Put parameter values in force at once, keeping the state; InputError refuses them all."""
        changed = {name: value for name, value in values.items() if value != self._model.values[name]}
        if not changed:
            return
        self._model = self._model.with_values(changed)
        if isinstance(self._plant, Plant):
            self._plant.model = self._model
        else:
            self._plant.values = self._model.values

    def reset(self) -> None:
        """Back to the closed stop, at rest and cold."""
        self._plant.reset()

    def advance(self, duty: float, duration: float) -> None:
        """Let `duty` act for `duration` [s]."""
        self._plant.advance(duty, duration)

    def measure(self) -> float:
        """One sample of the Hall voltage [V]."""
        return self._plant.measure()

    @property
    def noise(self) -> float:
        """Standard deviation of the sensor noise [V]."""
        return self._plant.noise

    @noise.setter
    def noise(self, noise: float) -> None:
        self._plant.noise = noise

    def _made(self, noise: float, seed: int) -> Plant | TextbookPlant:
        if not self._textbook:
            return Plant(self._model, noise, seed)
        from pierburg_ros.proof.formulation import TextbookPlant

        return TextbookPlant(self._model.values, noise, seed)


def chosen_model(actuator: str, path: str) -> Model:
    """The model of a file, or the nominal one of an actuator where no file is named."""
    model = read_model(path) if path else Model.nominal(read_actuator(actuator))
    if model.actuator.drive != "voltage":
        raise InputError(
            f"Actuator {model.actuator.name} is driven by a {model.actuator.input}; the plant needs one that is driven "
            "by a duty. Use 'pierburg simulate' for this one."
        )
    if model.actuator.quantity != "hall_voltage":
        raise InputError(
            f"Actuator {model.actuator.name} measures its {model.actuator.quantity}; the plant needs one "
            "that gives a Hall voltage. Use 'pierburg simulate' for this one."
        )
    return model


def declaration(model: Model, name: str) -> Declaration:
    """A model's parameter as a ROS parameter."""
    minimum, maximum = model.range(name)
    meaning = (model.actuator.parameters.get(name) or DECLARED[name]).meaning
    return Declaration(name, float(model.values[name]), meaning, model.actuator.unit_of(name), minimum, maximum)
