"""A model: an actuator, the values of its parameters, the effects that act, and a residual torque if any."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import yaml

from pierburg_ros.actuators import Actuator, Scales
from pierburg_ros.actuators.values import accepted, check, check_together, described
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.effects.effect import DRIVES, SENSORS
from pierburg_ros.errors import InputError
from pierburg_ros.plant.parameters import NEUTRAL, RESIDUAL_ANGLES, RESIDUAL_NODES, RESIDUAL_VELOCITIES, pack


class Values(dict[str, float]):
    """Values by dotted name that stay as they are; as fast to read as any dict."""

    def _refuse(self, *_: Any, **__: Any) -> NoReturn:
        raise TypeError("A model never changes. with_values gives another one.")

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[Any, ...]:
        return Values, (dict(self),)


@dataclass(frozen=True)
class Model:
    """Flat `values` by dotted name (`armature_resistance`, `effect.parameter`), complete: absent effects read 0."""

    actuator: Actuator
    values: dict[str, float]
    residual_torque: Mapping[str, Any] | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", Values(self.values))

    @staticmethod
    def nominal(actuator: Actuator) -> Model:
        """The actuator as described."""
        return Model(actuator, described(actuator))

    def with_values(self, changes: Mapping[str, float]) -> Model:
        """The model with some values changed; InputError where a name is unknown or a value not allowed."""
        if not isinstance(changes, Mapping):
            raise InputError(f"Found values as {type(changes).__name__}, expected a dict of them by name. Give one.")
        for name, value in changes.items():
            check(self.actuator, name, value)
        values = {**self.values, **changes}
        check_together(self.actuator, values)
        return Model(self.actuator, values, self.residual_torque)

    def with_residual(self, residual_torque: Mapping[str, Any] | None) -> Model:
        """The model with a residual torque: `angle` [rad], `velocity` [rad/s], `torque` [N.m] on their grid.

        With a `period` [rad] the angle begins again after it; the last node is then the first one's torque again.
        """
        if residual_torque is not None:
            _check_residual(residual_torque)
        return Model(self.actuator, self.values, residual_torque)

    @property
    def active_effects(self) -> tuple[str, ...]:
        """Ids of the effects that act, in the order of the signal path."""
        return tuple(effect.id for effect in EFFECTS if effect.acts(self.values))

    def range(self, name: str) -> tuple[float, float]:
        """Accepted range of the parameter called `name`; InputError where there is none."""
        return accepted(self.actuator, name)

    @property
    def scales(self) -> Scales:
        """What is large for the actuator as described."""
        return self.actuator.scales

    def record(self) -> np.ndarray:
        """The parameter record that the kernels read, shape (1,); one record for all runs of a model."""
        return self._packed

    @cached_property
    def _packed(self) -> np.ndarray:
        a = self.actuator
        values = {**NEUTRAL, **self.values}
        kinds = DRIVES.index(a.drive), SENSORS.index(a.quantity)
        return pack(values, a.lower_stop, a.upper_stop, *kinds, a.sensor_span, self.scales, self.residual_torque)

    def as_mapping(self) -> dict[str, Any]:
        """The model file's content: what differs from nominal, the effects that act, the residual torque.

        An actuator of the user's own stands in it as described, so that the file works wherever it is taken.
        """
        parameters = {
            name: self.values[name] for name, p in self.actuator.parameters.items() if self.values[name] != p.nominal
        }
        effects = {
            effect: {name: self.values[f"{effect}.{name}"] for name in EFFECT[effect].names}
            for effect in {**self.actuator.effects, **dict.fromkeys(self.active_effects)}
        }
        actuator = self.actuator.description or self.actuator.name
        content: dict[str, Any] = {"actuator": actuator, "parameters": parameters, "effects": effects}
        if self.residual_torque is not None:
            content["residual_torque"] = {
                key: np.asarray(values).tolist() for key, values in self.residual_torque.items()
            }
        return content

    def text(self) -> str:
        """The model file (section 6 of docs/contract.md)."""
        return yaml.safe_dump(_plain(self.as_mapping()), sort_keys=False, default_flow_style=None)

    def write(self, path: str | Path) -> None:
        """Write the model file."""
        Path(path).write_text(self.text(), encoding="utf-8")


def _plain(value: Any) -> Any:
    """`value` with NumPy numbers made Python's, as YAML wants them."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, np.generic):
        return value.item()
    return value


def _check_residual(residual: Mapping[str, Any]) -> None:
    if set(residual) - {"period"} != {"angle", "velocity", "torque"}:
        raise InputError(f"residual_torque has {', '.join(residual)}; expected angle, velocity and torque.")
    angle, velocity = (np.asarray(residual[key], dtype=float) for key in ("angle", "velocity"))
    torque = np.asarray(residual["torque"], dtype=float)
    for name, axis, most in (("angle", angle, RESIDUAL_ANGLES), ("velocity", velocity, RESIDUAL_VELOCITIES)):
        increasing = axis.ndim == 1 and 0 < axis.size <= most and bool(np.all(np.diff(axis) > 0))
        if not increasing or not np.all(np.isfinite(axis)):
            raise InputError(f"residual_torque.{name} is unusable; expected 1 to {most} increasing numbers.")
    if angle.size * velocity.size > RESIDUAL_NODES:
        raise InputError(f"residual_torque has {angle.size * velocity.size} nodes; expected {RESIDUAL_NODES} at most.")
    if torque.shape != (angle.size, velocity.size) or not np.all(np.isfinite(torque)):
        raise InputError(
            f"residual_torque.torque has shape {torque.shape}; expected {(angle.size, velocity.size)}, finite."
        )
    period = float(residual.get("period", 0.0))
    if period != 0.0 and not (math.isfinite(period) and period >= float(angle[-1] - angle[0]) > 0.0):
        raise InputError(
            f"residual_torque.period is {period:g} rad; expected at least what the nodes of the angle span."
        )
