"""The parameter record: every number of the plant in one nested NumPy record, read as `p.backlash.gap`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import count
from typing import Any

import numpy as np

from pierburg_ros.effects import EFFECTS

RESIDUAL_NODES = 24
"""Most nodes an axis of the residual torque may have."""

BASE = (
    "armature_resistance",
    "torque_constant",
    "gear_ratio",
    "spring_stiffness",
    "spring_preload",
    "gravity_torque",
    "coulomb_friction",
    "total_inertia",
    "supply_voltage",
    "hall_voltage_closed",
    "hall_voltage_open",
)
"""Names of the base parameters, units as in the actuator description."""

RESIDUAL = np.dtype(
    [
        ("angles", np.int64),
        ("velocities", np.int64),
        ("angle", np.float64, (RESIDUAL_NODES,)),
        ("velocity", np.float64, (RESIDUAL_NODES,)),
        ("torque", np.float64, (RESIDUAL_NODES, RESIDUAL_NODES)),
    ]
)

PARAMETERS = np.dtype(
    [(name, np.float64) for name in BASE]
    + [("lower_stop", np.float64), ("upper_stop", np.float64)]
    + [("serial", np.int64), ("finest", np.float64), ("measures_position", np.bool_)]
    + [("linear", np.bool_), ("plain", np.bool_), ("sensor_moves", np.bool_)]
    + [(effect.id, [(name, np.float64) for name in effect.names]) for effect in EFFECTS]
    + [("residual", RESIDUAL)],
    align=True,
)

_BENDING_STAGES = ("load", "friction")
_STRAIGHT = ("viscous_friction", "direction_dependent_friction")
_SENSOR_STATES = ("sensor_lag", "sensor_hysteresis")
_MEMORIES = ("input_delay", "thermal_resistance", "armature_inductance", "backlash", "gear_compliance", *_SENSOR_STATES)
_serial = count(1)


def pack(
    values: Mapping[str, float],
    lower_stop: float,
    upper_stop: float,
    measures_position: bool,
    residual: Mapping[str, Any] | None = None,
) -> np.ndarray:
    """Parameter record, shape (1,), from flat dotted names.

    `plain` says that torques are straight lines of angle and velocity between events, `linear` that nothing but
    angle and velocity has a memory besides, `finest` [rad] over which travel torques may bend; `serial` tells
    one record from any other.
    """
    record = np.zeros(1, PARAMETERS)
    for name in BASE:
        record[name] = values[name]
    for effect in EFFECTS:
        record[effect.id] = tuple(values[f"{effect.id}.{name}"] for name in effect.names)
    record["lower_stop"], record["upper_stop"] = lower_stop, upper_stop
    record["measures_position"] = measures_position
    _pack_residual(record, residual)
    present = {e.id for e in EFFECTS if any(values[f"{e.id}.{name}"] != 0.0 for name in e.strength)}
    bending = {e.id for e in EFFECTS if e.stage in _BENDING_STAGES and e.id not in _STRAIGHT}
    plain = not (present & bending) and values["gravity_torque"] == 0.0 and residual is None
    record["plain"] = plain
    record["linear"] = plain and not present.intersection(_MEMORIES)
    record["sensor_moves"] = bool(present.intersection(_SENSOR_STATES))
    record["finest"] = _finest(values, residual)
    record["serial"] = next(_serial)
    return record


def _finest(values: Mapping[str, float], residual: Mapping[str, Any] | None) -> float:
    """Travel [rad] within which no torque over the angle turns more than once."""
    ripple = values["cogging_torque.periods_per_motor_revolution"] * values["gear_ratio"]
    features = [
        0.5 if values["gravity_torque"] != 0.0 else math.inf,
        2.0 / ripple if values["cogging_torque.amplitude"] * ripple > 0.0 else math.inf,
        values["position_dependent_friction.width"]
        if values["position_dependent_friction.amplitude"] != 0.0
        else math.inf,
    ]
    if residual is not None and np.size(residual["angle"]) > 1:
        features.append(float(np.min(np.diff(residual["angle"]))))
    return min(features)


def _pack_residual(record: np.ndarray, residual: Mapping[str, Any] | None) -> None:
    if residual is None:
        return
    angle, velocity = np.asarray(residual["angle"]), np.asarray(residual["velocity"])
    grid = record["residual"]
    grid["angles"], grid["velocities"] = angle.size, velocity.size
    grid["angle"][0, : angle.size] = angle
    grid["velocity"][0, : velocity.size] = velocity
    grid["torque"][0, : angle.size, : velocity.size] = residual["torque"]
