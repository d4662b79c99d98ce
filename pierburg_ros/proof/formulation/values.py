"""The numbers of the textbook formulation: Table I, the catalogue's parameters, and what lies outside it.

Names and units are those of section 7 of docs/contract.md; they are written out a second time on purpose.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError

NOMINAL: dict[str, float] = {
    "armature_resistance": 4.139,  # ohm, Table I
    "torque_constant": 0.022,  # N.m/A, Table I
    "gear_ratio": 37.3,  # 1, Table I
    "spring_stiffness": 0.1419,  # N.m/rad, Table I
    "spring_preload": 0.29,  # N.m, Table I
    "coulomb_friction": 0.2007,  # N.m, Table I
    "total_inertia": 2.4602e-6,  # kg.m^2, Table I
    "supply_voltage": 13.5,  # V, section 1 of docs/contract.md
    "hall_voltage_closed": 0.42,  # V, paper
    "hall_voltage_open": 4.52,  # V, paper
}

CATALOGUE: dict[str, tuple[str, ...]] = {
    "viscous_friction": ("coefficient",),
    "drag": ("quadratic", "cubic"),
    "static_friction": ("breakaway_torque", "stribeck_velocity"),
    "presliding": ("stiffness", "damping"),
    "load_dependent_friction": ("coefficient",),
    "direction_dependent_friction": ("viscous_difference", "coulomb_difference"),
    "position_dependent_friction": ("amplitude", "center", "width"),
    "backlash": ("gap", "motor_friction_share"),
    "gear_compliance": ("stiffness", "damping"),
    "cogging_torque": ("amplitude", "periods_per_motor_revolution", "phase"),
    "nonlinear_spring": ("cubic_stiffness", "knee_stiffness", "knee_angle"),
    "stop_compliance": ("stiffness", "damping"),
    "external_load": ("torque", "amplitude", "frequency", "phase", "start", "end"),
    "thermal_resistance": ("thermal_resistance", "heat_capacity"),
    "supply_sag": ("source_resistance",),
    "pwm_deadband": ("width",),
    "armature_inductance": ("inductance",),
    "input_delay": ("delay",),
    "sensor_lag": ("time_constant",),
    "sensor_nonlinearity": ("amplitude", "half_waves"),
    "sensor_hysteresis": ("width",),
    "sensor_quantization": ("step",),
}

OUTSIDE: dict[str, tuple[str, ...]] = {
    "relaxation": ("stiffness", "time_constant"),  # N.m/rad, s: spring with a viscoelastic (Maxwell) branch
    "magnet_fading": ("share", "time_constant"),  # 1, s: torque constant falls by `share` as the magnets warm
    "spring_set": ("torque", "exposure"),  # N.m, rad.s: preload lost while the spring is held open
    "hysteretic_spring": ("stiffness", "yield_torque"),  # N.m/rad, N.m: rate-free hysteresis
    "detent": ("torque", "center", "width"),  # N.m, rad, rad: a magnetic notch that pulls to its centre
    "ageing_friction": ("growth", "time_constant"),  # 1, s: dry friction grows by `growth` while the shaft rests
}

EFFECTS = {**CATALOGUE, **OUTSIDE}
RECORD = np.dtype(
    [(name, np.float64) for name in NOMINAL]
    + [(name, [(field, np.float64) for field in fields]) for name, fields in EFFECTS.items()]
)
STRENGTHS = {
    "drag": ("quadratic", "cubic"),
    "direction_dependent_friction": ("viscous_difference", "coulomb_difference"),
    "nonlinear_spring": ("cubic_stiffness", "knee_stiffness"),
    "external_load": ("torque", "amplitude"),
}
FOREVER = 1e9


def textbook_values(values: Mapping[str, float]) -> dict[str, float]:
    """Every value by its flat dotted name: the given ones over Table I, absent effects 0."""
    complete = dict(NOMINAL)
    complete.update({f"{effect}.{field}": 0.0 for effect, fields in EFFECTS.items() for field in fields})
    unknown = sorted(set(values) - set(complete))
    if unknown:
        raise InputError(f"found value {unknown[0]!r}, expected names of section 2 or section 7 of docs/contract.md.")
    complete.update({name: float(value) for name, value in values.items()})
    if complete["external_load.end"] <= complete["external_load.start"]:
        complete["external_load.end"] = FOREVER
    heating = complete["thermal_resistance.thermal_resistance"] > 0
    if heating and complete["thermal_resistance.heat_capacity"] <= 0:
        raise InputError("found heating with a heat_capacity of 0 J/K; give a positive one.")
    return complete


def record(values: Mapping[str, float]) -> Any:
    """Values as the one-element structured array the kernels take."""
    array = np.zeros(1, RECORD)
    for name, value in textbook_values(values).items():
        effect, _, field = name.partition(".")
        if field:
            array[effect][field] = value
        else:
            array[name] = value
    return array


def active_outside(values: Mapping[str, float]) -> tuple[str, ...]:
    """Names of the physics outside the catalogue that `values` switches on."""
    return tuple(name for name, fields in OUTSIDE.items() if values.get(f"{name}.{fields[0]}", 0.0) != 0.0)
