"""The numbers of a model on their way into a format: what a format takes it holds, all else is left out and listed."""

from __future__ import annotations

from dataclasses import dataclass, field

from pierburg_ros.effects import EFFECT, Effect
from pierburg_ros.effects.effect import Place, Quantity
from pierburg_ros.plant import Model

IDENTITY = {"torque_scale": 1.0, "sensor_scale": 1.0}
"""Values at which a base parameter changes nothing, where that is not 0."""


@dataclass(frozen=True)
class LeftOut:
    """A number of the model that a format does not hold; `effect` is None for a base parameter."""

    effect: str | None
    parameter: str
    value: float | None
    unit: str

    @property
    def text(self) -> str:
        """Effect, parameter and value, for people."""
        name = f"{self.effect}.{self.parameter}" if self.effect else self.parameter
        return name if self.value is None else f"{name} {self.value:.6g}{' ' + self.unit if self.unit != '1' else ''}"


@dataclass(frozen=True)
class Exported:
    """A model in another format: the text of the file, what it lacks, and what it holds in another way."""

    text: str
    left_out: tuple[LeftOut, ...]
    notes: tuple[str, ...]


@dataclass
class Contents:
    """A model that a format reads number by number.

    Whatever is read counts as held, so nothing gets lost without being listed. `notes` say what is held in another way.
    """

    model: Model
    notes: list[str] = field(default_factory=list)
    _read: set[str] = field(default_factory=set)

    def base(self, name: str) -> float:
        """A base parameter, in its unit; where the actuator has none, the value at which it changes nothing."""
        self._read.add(name)
        return self.model.values.get(name, IDENTITY.get(name, 0.0))

    def quantity(self, name: Quantity) -> float:
        """What effects that act give for a quantity that other simulators know, in SI units; 0 where none does."""
        for effect in self._acting():
            parameter = effect.elsewhere.quantities.get(name)
            if parameter is not None:
                self._read.add(f"{effect.id}.{parameter}")
                return self.model.values[f"{effect.id}.{parameter}"]
        return 0.0

    def equations(self) -> list[tuple[Effect, dict[Place, str]]]:
        """Effects that act and have equations, in the order of the signal path, with these."""
        found = []
        for effect in self._acting():
            if effect.elsewhere.modelica:
                self._read.update(f"{effect.id}.{name}" for name in effect.names)
                found.append((effect, dict(effect.elsewhere.modelica)))
        return found

    def whole_effects(self) -> list[Effect]:
        """All effects that act, taken as they are."""
        for effect in self._acting():
            self._read.update(f"{effect.id}.{name}" for name in effect.names)
        return self._acting()

    def residual(self) -> bool:
        """Whether there is a residual torque, which then counts as held."""
        self._read.add("residual_torque")
        return self.model.residual_torque is not None

    def left_out(self) -> tuple[LeftOut, ...]:
        """What has not been read, in the order of the signal path; zeros are nothing to hold."""
        values, actuator = self.model.values, self.model.actuator
        base = [
            LeftOut(None, name, values[name], actuator.unit_of(name))
            for name in actuator.parameters
            if name not in self._read and values[name] != IDENTITY.get(name, 0.0)
        ]
        effects = [
            LeftOut(effect.id, name, values[f"{effect.id}.{name}"], actuator.unit_of(f"{effect.id}.{name}"))
            for effect in self._acting()
            for name in effect.names
            if f"{effect.id}.{name}" not in self._read and values[f"{effect.id}.{name}"] != 0.0
        ]
        lacks_residual = self.model.residual_torque is not None and "residual_torque" not in self._read
        return (
            *base,
            *effects,
            *([LeftOut(None, "residual_torque", None, actuator.shown("N.m"))] if lacks_residual else []),
        )

    def exported(self, text: str) -> Exported:
        """The finished text with what it lacks."""
        return Exported(text, self.left_out(), tuple(self.notes))

    def _acting(self) -> list[Effect]:
        return [EFFECT[name] for name in self.model.active_effects]
