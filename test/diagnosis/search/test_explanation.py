"""Explanations: their size, and the way between values and search coordinates."""

import numpy as np
import pytest
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search.candidates import STARTS
from pierburg_ros.diagnosis.search.explanation import (
    AFTER,
    WHEN,
    Coordinates,
    Explanation,
    Variant,
    quantities,
    without,
)

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
LAG = Variant("sensor_lag", ("time_constant",))


def test_each_drift_change_and_effect_counts_one() -> None:
    assert Explanation().size == 0
    assert Explanation(("spring_preload",), (STICTION, LAG), "armature_resistance").size == 4


def test_taking_a_quantity_away_leaves_the_others() -> None:
    whole = Explanation(("spring_preload",), (STICTION, LAG), "armature_resistance")
    for quantity in quantities(whole):
        assert without(whole, quantity).size == 3
        assert quantity not in quantities(without(whole, quantity))


@pytest.mark.parametrize("variant", list(STARTS), ids=lambda variant: variant.label + "-" + variant.free[0])
def test_values_survive_the_way_through_coordinates(variant: Variant) -> None:
    names = tuple(f"{variant.effect}.{name}" for name in variant.free)
    coordinates = Coordinates(("coulomb_friction", *names), NOMINAL, 60.0)
    values = {f"{variant.effect}.{name}": value for name, value in STARTS[variant][0].items()}
    values["coulomb_friction"] = 0.18
    if "static_friction.breakaway_torque" in values:
        values["static_friction.breakaway_torque"] += 0.18
    assert coordinates.values(coordinates.point(values)) == pytest.approx(values)


def test_a_breakaway_torque_never_falls_below_the_sliding_friction() -> None:
    coordinates = Coordinates(("coulomb_friction", *Explanation((), (STICTION,)).names), NOMINAL, 60.0)
    lower, _ = coordinates.bounds()
    values = coordinates.values(lower)
    assert values["static_friction.breakaway_torque"] >= values["coulomb_friction"]


def test_a_change_has_a_value_before_one_after_and_a_time() -> None:
    names = Explanation(changed="armature_resistance").names
    coordinates = Coordinates(names, NOMINAL, 60.0)
    values = {
        "armature_resistance": 4.2,
        "armature_resistance" + AFTER: 5.0,
        "armature_resistance" + WHEN: 20.0,
    }
    assert coordinates.values(coordinates.point(values)) == pytest.approx(values)
    assert np.all(coordinates.steps() > 0)
