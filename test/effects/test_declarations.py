"""The catalogue is the contract's: ids, names and units, and declarations that hold together."""

from __future__ import annotations

import re

import pytest

from pierburg_ros.actuators import SHIPPED, Scales, read_actuator
from pierburg_ros.effects import EFFECT, EFFECTS, Effect
from pierburg_ros.intake.bounds import LARGEST

CATALOGUE = {
    "viscous_friction": {"coefficient": "N.m.s/rad"},
    "drag": {"quadratic": "N.m.s^2/rad^2", "cubic": "N.m.s^3/rad^3"},
    "static_friction": {"breakaway_torque": "N.m", "stribeck_velocity": "rad/s"},
    "presliding": {"stiffness": "N.m/rad", "damping": "N.m.s/rad"},
    "load_dependent_friction": {"coefficient": "1"},
    "direction_dependent_friction": {"viscous_difference": "N.m.s/rad", "coulomb_difference": "N.m"},
    "position_dependent_friction": {"amplitude": "N.m", "center": "rad", "width": "rad"},
    "backlash": {"gap": "rad", "motor_friction_share": "1"},
    "gear_compliance": {"stiffness": "N.m/rad", "damping": "N.m.s/rad"},
    "cogging_torque": {"amplitude": "N.m", "periods_per_motor_revolution": "1", "phase": "rad"},
    "nonlinear_spring": {"cubic_stiffness": "N.m/rad^3", "knee_stiffness": "N.m/rad", "knee_angle": "rad"},
    "stop_compliance": {"stiffness": "N.m/rad", "damping": "N.m.s/rad"},
    "external_load": {
        "torque": "N.m",
        "amplitude": "N.m",
        "frequency": "Hz",
        "phase": "rad",
        "start": "s",
        "end": "s",
    },
    "thermal_resistance": {"thermal_resistance": "K/W", "heat_capacity": "J/K"},
    "supply_sag": {"source_resistance": "ohm"},
    "pwm_deadband": {"width": "1"},
    "armature_inductance": {"inductance": "H"},
    "input_delay": {"delay": "s"},
    "sensor_lag": {"time_constant": "s"},
    "sensor_nonlinearity": {"amplitude": "1", "half_waves": "1"},
    "sensor_hysteresis": {"width": "rad"},
    "sensor_quantization": {"step": "V"},
}
"""Section 7 of docs/contract.md: published ids keep their meaning."""


def test_published_effects_keep_their_names_and_units() -> None:
    declared = {effect.id: {p.name: p.unit for p in effect.parameters} for effect in EFFECTS}
    assert {name: declared[name] for name in CATALOGUE} == CATALOGUE


def test_ids_are_unique() -> None:
    assert len(EFFECT) == len(EFFECTS)


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.id)
def test_declaration_is_complete(effect: Effect) -> None:
    texts = (effect.sentence, effect.equation, effect.source, effect.shows_in, effect.record)
    assert all(text.strip() for text in texts)
    assert effect.sentence.endswith(".")
    assert set(effect.strength) <= set(effect.names) and effect.strength[0] == effect.names[0]


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.id)
def test_the_source_is_authors_title_and_year(effect: Effect) -> None:
    """`Authors, Title (year)`, or `Title (n.d.)` where neither is known; then, where needed, a place in it."""
    assert re.fullmatch(r"([A-Z].*, [A-Z].* \((18|19|20)\d\d\)|[A-Z].* \(n\.d\.\))(, \w.*)?", effect.source)


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.id)
def test_plausible_ranges_lie_within_those_searched_and_accepted(effect: Effect) -> None:
    for name in SHIPPED:
        scales = Scales.of(read_actuator(name))
        for parameter in effect.parameters:
            low, high = parameter.expected(scales)
            assert parameter.minimum <= low <= high <= parameter.maximum, parameter.name
            assert set(parameter.choices) <= {low, high}, parameter.name
            if parameter.searched is not None:
                assert parameter.searched[0] <= parameter.plausible[0], parameter.name
                assert parameter.plausible[1] <= parameter.searched[1], parameter.name


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.id)
def test_what_is_accepted_excludes_only_the_impossible(effect: Effect) -> None:
    """A number with a unit has no largest value: only signs, shares and angles that repeat themselves are bounded."""
    for parameter in effect.parameters:
        if (parameter.measure or parameter.unit) != "1":
            assert parameter.maximum == LARGEST, parameter.name
            assert parameter.minimum in (0.0, -LARGEST), parameter.name
