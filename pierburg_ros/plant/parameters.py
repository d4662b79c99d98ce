"""The parameter record: every number of the plant in one nested NumPy record, read as `p.effect.parameter`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import count
from typing import Any

import numpy as np

from pierburg_ros.actuators import Scales
from pierburg_ros.effects import EFFECTS, Effect

RESIDUAL_ANGLES, RESIDUAL_VELOCITIES = 512, 24
"""Most nodes that the residual torque may have over the angle and over the velocity."""
RESIDUAL_NODES = 1024
"""Most nodes that it may have in all."""

FACTORS = ("armature_resistance", "torque_constant", "gear_ratio", "torque_scale", "sensor_scale")
"""Base parameters that multiply or divide."""
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
    "torque_scale",
    "sensor_scale",
    "sensor_offset",
)
"""Names of the base parameters, units as in the actuator description."""
NEUTRAL = {**dict.fromkeys(BASE, 0.0), **dict.fromkeys(FACTORS, 1.0)}
"""Value of each base parameter in an actuator that has none: it then changes nothing."""

RESIDUAL = np.dtype(
    [
        ("angles", np.int64),
        ("velocities", np.int64),
        ("period", np.float64),  # rad, after which the angle begins again; 0: it does not
        ("angle", np.float64, (RESIDUAL_ANGLES,)),
        ("velocity", np.float64, (RESIDUAL_VELOCITIES,)),
        ("torque", np.float64, (RESIDUAL_NODES,)),  # row by row, one for each angle
    ]
)

OWN = np.dtype([("torque", np.float64), ("angle", np.float64), ("time", np.float64)])
"""What is large for the actuator [N.m, rad, s]: the tolerances of the kernels are shares of these."""

PARAMETERS = np.dtype(
    [(name, np.float64) for name in BASE]
    + [("lower_stop", np.float64), ("upper_stop", np.float64)]
    + [("drive", np.int64), ("sensor", np.int64), ("sensor_span", np.float64)]
    + [("agility", np.float64), ("own", OWN), ("serial", np.int64), ("finest", np.float64), ("ripple", np.float64)]
    + [("plain", np.bool_), ("sensor_moves", np.bool_), ("creeps", np.bool_)]
    + [(effect.id, [(name, np.float64) for name in effect.names]) for effect in EFFECTS]
    + [("residual", RESIDUAL)],
    align=True,
)


def _offset(record: np.dtype[np.void], name: str) -> int:
    """Where the field called `name` begins in a `record` [bytes]."""
    assert record.fields is not None
    return record.fields[name][1]


_NUMBERS = {
    **{name: _offset(PARAMETERS, name) for name in BASE},
    **{
        f"{effect.id}.{name}": _offset(PARAMETERS, effect.id) + _offset(PARAMETERS[effect.id], name)
        for effect in EFFECTS
        for name in effect.names
    },
}
"""Where each number begins in the record [bytes], by dotted name."""
_PLACES = np.array(list(_NUMBERS.values())) // np.dtype(np.float64).itemsize
_OUTSIDE = ("input", "drive", "sensor")
"""Stages whose states are advanced beside the mechanics: in short stretches, at whose ends the two meet."""
_serial = count(1)


def pack(
    values: Mapping[str, float],
    lower_stop: float,
    upper_stop: float,
    drive: int,
    sensor: int,
    sensor_span: float,
    scales: Scales,
    residual: Mapping[str, Any] | None = None,
) -> np.ndarray:
    """Parameter record, shape (1,), from flat dotted names.

    `drive` and `sensor` are the places of their kinds in `DRIVES` and `SENSORS`, `sensor_span` [rad] is the angle
    between the two Hall end voltages.
    `agility` is one over the inertia; `plain` says that torques are straight lines of angle and velocity between
    events, `finest` [rad] over which travel torques may bend throughout, `ripple` [rad] the same of a ripple.
    `creeps` says that states of drive or sensor change between events, `sensor_moves` that those of the sensor do;
    `serial` tells one record from any other.
    """
    record = np.zeros(1, PARAMETERS)
    record.view(np.float64)[_PLACES] = [values[name] for name in _NUMBERS]
    record["lower_stop"], record["upper_stop"] = lower_stop, upper_stop
    record["drive"], record["sensor"], record["sensor_span"] = drive, sensor, sensor_span
    record["agility"] = 1.0 / values["total_inertia"]
    record["own"] = scales.torque, scales.angle, scales.time
    _pack_residual(record, residual)
    present = [effect for effect in EFFECTS if effect.acts(values)]
    creeping = {effect.stage for effect in present if effect.state and effect.stage in _OUTSIDE}
    plain = all(effect.linear for effect in present) and values["gravity_torque"] == 0.0 and residual is None
    record["plain"] = plain
    record["creeps"], record["sensor_moves"] = bool(creeping), "sensor" in creeping
    rippling = [effect for effect in present if effect.ripple is not None]
    record["ripple"] = _finest(rippling, values)
    smooth = [effect for effect in present if effect.ripple is None]
    record["finest"] = min(_finest(smooth, values), _shaped(values, residual))
    record["serial"] = next(_serial)
    return record


def _finest(effects: Sequence[Effect], values: Mapping[str, float]) -> float:
    """Travel [rad] within which no torque of these effects turns more than once over the angle."""
    return min((effect.turns_within(values) for effect in effects if effect.turns_within is not None), default=math.inf)


def _shaped(values: Mapping[str, float], residual: Mapping[str, Any] | None) -> float:
    """The same of gravity and of a residual torque."""
    turns = 0.5 if values["gravity_torque"] != 0.0 else math.inf
    if residual is not None and np.size(residual["angle"]) > 1:
        return min(turns, float(np.min(np.diff(residual["angle"]))))
    return turns


def _pack_residual(record: np.ndarray, residual: Mapping[str, Any] | None) -> None:
    if residual is None:
        return
    angle, velocity = np.asarray(residual["angle"]), np.asarray(residual["velocity"])
    grid = record["residual"]
    grid["angles"], grid["velocities"] = angle.size, velocity.size
    grid["angle"][0, : angle.size] = angle
    grid["velocity"][0, : velocity.size] = velocity
    grid["period"] = residual.get("period", 0.0)
    grid["torque"][0, : angle.size * velocity.size] = np.ravel(residual["torque"])
