"""JSON: the whole model, each number with its unit, meaning and origin, each effect with its equation and source."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.effects import DECLARED, Effect
from pierburg_ros.export.contents import Contents

EQUATIONS = (
    "armature voltage = duty x supply_voltage = armature_resistance x i + gear_ratio x torque_constant x w",
    "motor torque T_m = gear_ratio x torque_constant x i",
    "load torque = spring_preload + spring_stiffness x angle + gravity_torque x sin(angle)",
    "friction: at rest whatever holds, up to coulomb_friction; in motion coulomb_friction x sign(w)",
    "total_inertia x dw/dt = T_m - load torque - friction, w = d(angle)/dt; w = 0 at a stop",
    "hall_voltage = hall_voltage_closed + (hall_voltage_open - hall_voltage_closed) x angle / (pi/2)",
)
"""The plant without effects: equations (1) to (8) of the paper. Those of effects say what they change."""


def json_document(contents: Contents) -> str:
    """The model as JSON; nothing is left out."""
    actuator = contents.model.actuator
    content: dict[str, Any] = {
        "schema": 1,
        "actuator": actuator.name,
        "title": actuator.title,
        "load": actuator.load,
        "quantity": actuator.quantity,
        "unit": actuator.unit,
        "stops": {"lower": finite(actuator.lower_stop), "upper": finite(actuator.upper_stop), "unit": "rad"},
        "equations": list(EQUATIONS),
        "parameters": {name: parameter(contents, name) for name in actuator.parameters},
        "effects": [described(contents, effect) for effect in contents.whole_effects()],
        "residual_torque": residual(contents),
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def parameter(contents: Contents, name: str) -> dict[str, Any]:
    """A base parameter with all that is known of it."""
    about, (unit, meaning) = contents.model.actuator.parameters[name], UNITS[name]
    value = contents.base(name)
    return {"value": value, "unit": unit, "nominal": about.nominal, "meaning": meaning, "origin": about.origin}


def described(contents: Contents, effect: Effect) -> dict[str, Any]:
    """An effect with its equation and numbers."""
    numbers = {
        name: {
            "value": contents.model.values[f"{effect.id}.{name}"],
            "unit": DECLARED[f"{effect.id}.{name}"].unit,
            "meaning": DECLARED[f"{effect.id}.{name}"].meaning,
        }
        for name in effect.names
    }
    about = {"id": effect.id, "stage": effect.stage, "sentence": effect.sentence}
    return {**about, "equation": effect.equation, "source": effect.source, "parameters": numbers}


def residual(contents: Contents) -> dict[str, Any] | None:
    """The residual torque on its grid, added to the load torque, bilinear between nodes and clamped at the edges."""
    if not contents.residual():
        return None
    assert contents.model.residual_torque is not None
    grid = {key: np.asarray(contents.model.residual_torque[key]).tolist() for key in ("angle", "velocity", "torque")}
    return {**grid, "units": {"angle": "rad", "velocity": "rad/s", "torque": "N.m"}}


def finite(value: float) -> float | None:
    """`value`, or None where there is no such stop."""
    return value if math.isfinite(value) else None
