"""What may be the case: which parameters may drift, how a catalogue effect may act, and where its search starts."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.diagnosis.evidence.data import EvidenceData
from pierburg_ros.diagnosis.evidence.missing_torque import MissingTorque, missing_torque, rhythms, spans, tight_spots
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.plant import Model

Signal = NDArray[np.float64]
Start = dict[str, float]


def _grid(**values: tuple[float, ...]) -> list[Start]:
    return [dict(zip(values, row, strict=True)) for row in itertools.product(*values.values())]


_BOTH = (0.0, math.pi / 2)

STARTS: dict[Variant, list[Start]] = {
    Variant("input_delay", ("delay",)): _grid(delay=(0.003, 0.01, 0.02, 0.035, 0.06, 0.12)),
    Variant("pwm_deadband", ("width",)): _grid(width=(0.005, 0.015, 0.04)),
    Variant("supply_sag", ("source_resistance",)): _grid(source_resistance=(0.5, 1.5, 3.0)),
    Variant("thermal_resistance", ("thermal_resistance", "heat_capacity")): _grid(
        thermal_resistance=(10.0, 30.0), heat_capacity=(0.15, 0.5, 2.0)
    ),
    Variant("armature_inductance", ("inductance",)): _grid(inductance=(0.001, 0.005)),
    Variant("backlash", ("gap", "motor_friction_share")): _grid(
        gap=(0.015, 0.04, 0.08), motor_friction_share=(0.1, 0.4)
    ),
    Variant("gear_compliance", ("stiffness", "damping")): _grid(stiffness=(4.0, 12.0, 40.0), damping=(0.01,)),
    Variant("nonlinear_spring", ("cubic_stiffness",)): _grid(cubic_stiffness=(0.03,)),
    Variant("nonlinear_spring", ("knee_stiffness", "knee_angle")): _grid(
        knee_stiffness=(0.1,), knee_angle=(0.3, 0.6, 0.9, 1.2)
    ),
    Variant("stop_compliance", ("stiffness", "damping")): _grid(stiffness=(6.0, 20.0, 60.0), damping=(0.02,)),
    Variant("viscous_friction", ("coefficient",)): _grid(coefficient=(0.03,)),
    Variant("static_friction", ("breakaway_torque", "stribeck_velocity")): _grid(
        breakaway_torque=(0.03, 0.06, 0.1), stribeck_velocity=(0.04, 0.12)
    ),
    Variant("load_dependent_friction", ("coefficient",)): _grid(coefficient=(0.03, 0.1)),
    Variant("direction_dependent_friction", ("viscous_difference",)): _grid(viscous_difference=(-0.03, 0.05)),
    Variant("direction_dependent_friction", ("coulomb_difference",)): _grid(coulomb_difference=(-0.03, 0.03)),
    Variant("direction_dependent_friction", ("viscous_difference", "coulomb_difference")): _grid(
        viscous_difference=(-0.03, 0.05), coulomb_difference=(-0.03, 0.03)
    ),
    Variant("presliding", ("stiffness", "damping")): _grid(stiffness=(5.0, 15.0, 50.0), damping=(0.02,)),
    Variant("sensor_hysteresis", ("width",)): _grid(width=(0.005, 0.02)),
    Variant("sensor_lag", ("time_constant",)): _grid(time_constant=(0.003, 0.01, 0.025)),
    Variant("sensor_nonlinearity", ("amplitude",), (("half_waves", 1.0),)): _grid(amplitude=(-0.03, 0.03)),
    Variant("sensor_nonlinearity", ("amplitude",), (("half_waves", 2.0),)): _grid(amplitude=(-0.03, 0.03)),
}
"""Starting values by variant; a breakaway torque is what exceeds the sliding friction, phases come in quadrature.

Cogging, tight spots and external loads start from what the data show, see `starts_of`. Steps of the converter are
not searched for but seen, see `resolution.py`."""


COGGING = Variant("cogging_torque", ("amplitude", "periods_per_motor_revolution", "phase"))
"""Cogging, the number of teeth unknown."""
PULSATION = Variant("external_load", ("amplitude", "frequency", "phase"))
"""A load that pulsates throughout."""
TURNS = (0.9, 16.0)
"""Range in which periods of cogging per motor revolution are looked for."""
FREQUENCIES = (0.1, 20.0)
"""Range in which the rhythm of a load is looked for [Hz]."""
ROUGH = frozenset({"static_friction", "backlash", "position_dependent_friction", "external_load", "input_delay"})
"""Effects whose cost has many local minima, since events jump with their parameters."""
TIMED = frozenset({"external_load", "thermal_resistance"})
"""Effects that go by the time since the start: the first part of a recording may not show them."""


def drifting(nominal: Model) -> tuple[str, ...]:
    """Names of what may drift: the free base parameters, and the parameters of effects the actuator always has."""
    own = tuple(f"{effect}.{name}" for effect, values in nominal.actuator.effects.items() for name in values)
    return nominal.actuator.free + own


def is_rough(explanation: Explanation) -> bool:
    """Whether the cost of an explanation has many local minima."""
    return not ROUGH.isdisjoint(explanation.effects)


def turns(missing: MissingTorque, model: Model) -> list[float]:
    """The strongest rhythms of a missing torque [periods per motor revolution], strongest first, at most four."""
    return rhythms(missing.angle * model.values["gear_ratio"] / (2 * math.pi), missing.torque, TURNS, 4)


def pulses(missing: MissingTorque) -> list[float]:
    """The strongest rhythms of a missing torque in time [Hz], strongest first, at most five."""
    return rhythms(missing.time, missing.torque, FREQUENCIES, 5)


def starts_of(data: EvidenceData, model: Model) -> dict[Variant, list[Start]]:
    """Starting values by variant on top of `model`: rhythms in angle and time from the torque that it misses."""
    starts = dict(STARTS)
    run = data.runs[0]
    missing = missing_torque(data, run, model)
    starts[COGGING] = [
        {"amplitude": 0.02, "periods_per_motor_revolution": periods, "phase": phase}
        for periods in dict.fromkeys((*turns(missing, model), 2.0, 3.0, 6.0))
        for phase in _BOTH
    ]
    starts[PULSATION] = [
        {"amplitude": 0.02, "frequency": frequency, "phase": phase} for frequency in pulses(missing) for phase in _BOTH
    ]
    starts[Variant("external_load", ("torque", "start", "end"))] = [
        {"torque": load, "start": start, "end": end}
        for start, end, load in spans(missing.time, missing.torque, float(run.time[-1]), 4)
    ]
    starts[Variant("position_dependent_friction", ("amplitude", "center", "width"))] = [
        {"amplitude": 0.04, "center": center, "width": width}
        for center in tight_spots(missing, 4)
        for width in (0.06, 0.2)
    ]
    return starts
