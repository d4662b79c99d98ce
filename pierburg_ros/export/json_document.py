"""JSON: the whole model, each number with its unit, meaning and origin, each effect with its equation and source."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from pierburg_ros.actuators.units import unit_of
from pierburg_ros.effects import DECLARED, Effect
from pierburg_ros.export.contents import Contents

DRIVES = {
    "voltage": (
        "armature voltage = duty x supply_voltage = armature_resistance x i + gear_ratio x torque_constant x w",
        "motor torque T_m = gear_ratio x torque_constant x i",
    ),
    "current": ("motor torque T_m = gear_ratio x torque_constant x current",),
    "torque": ("motor torque T_m = torque_scale x torque",),
}
SENSORS = {
    "hall_voltage": "hall_voltage = hall_voltage_closed"
    " + (hall_voltage_open - hall_voltage_closed) x angle / sensor_span",
    "position": "position = sensor_offset + sensor_scale x angle",
    "speed": "speed = sensor_offset + sensor_scale x w",
}
EQUATIONS = (
    "load torque = spring_preload + spring_stiffness x angle + gravity_torque x sin(angle)",
    "friction: at rest whatever holds, up to coulomb_friction; in motion coulomb_friction x sign(w)",
    "total_inertia x dw/dt = T_m - load torque - friction, w = d(angle)/dt; w = 0 at a stop",
)
"""The plant without effects: equations (1) to (8) of the paper. Those of effects say what they change."""


def json_document(contents: Contents) -> str:
    """The model as JSON; nothing is left out."""
    actuator = contents.model.actuator
    angle = unit_of("rad", actuator.motion)
    content: dict[str, Any] = {
        "schema": 1,
        "actuator": actuator.name,
        "title": actuator.title,
        "drive": actuator.drive,
        "load": actuator.load,
        "motion": actuator.motion,
        "joint": actuator.joint,
        "input": actuator.input,
        "quantity": actuator.quantity,
        "unit": actuator.unit,
        "stops": {"lower": finite(actuator.lower_stop), "upper": finite(actuator.upper_stop), "unit": angle},
        "sensor_span": {"value": actuator.sensor_span, "unit": angle},
        "equations": [*DRIVES[actuator.drive], *EQUATIONS, SENSORS[actuator.quantity]],
        "parameters": {name: parameter(contents, name) for name in actuator.parameters},
        "effects": [described(contents, effect) for effect in contents.whole_effects()],
        "residual_torque": residual(contents),
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def parameter(contents: Contents, name: str) -> dict[str, Any]:
    """A base parameter with all that is known of it."""
    about, value = contents.model.actuator.parameters[name], contents.base(name)
    return {
        "value": value,
        "unit": contents.model.actuator.unit_of(name),
        "nominal": about.nominal,
        "meaning": about.meaning,
        "origin": about.origin,
    }


def described(contents: Contents, effect: Effect) -> dict[str, Any]:
    """An effect with its equation and numbers."""
    numbers = {
        name: {
            "value": contents.model.values[f"{effect.id}.{name}"],
            "unit": contents.model.actuator.unit_of(f"{effect.id}.{name}"),
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
    grid = {key: np.asarray(values).tolist() for key, values in contents.model.residual_torque.items()}
    motion = contents.model.actuator.motion
    units = {"angle": "rad", "velocity": "rad/s", "torque": "N.m", "period": "rad"}
    return {**grid, "units": {name: unit_of(units[name], motion) for name in grid}}


def finite(value: float) -> float | None:
    """`value`, or None where there is no such stop."""
    return value if math.isfinite(value) else None
