"""Explanations: what they change, and how many quantities that is."""

import pytest

from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant, canonical, quantities, without

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
LAG = Variant("sensor_lag", ("time_constant",))
LOAD = Variant("external_load", ("torque", "start"), (("end", 0.0),))
WHOLE = Explanation(("spring_preload",), (STICTION, LAG), "armature_resistance")
ORDER = ("armature_resistance", "spring_preload", "viscous_friction.coefficient")


def test_each_drift_change_and_effect_counts_one() -> None:
    assert Explanation().size == 0
    assert WHOLE.size == len(quantities(WHOLE)) == 4


@pytest.mark.parametrize("quantity", quantities(WHOLE), ids=str)
def test_taking_a_quantity_away_leaves_the_others(quantity: str | Variant) -> None:
    rest = without(WHOLE, quantity)
    assert set(quantities(rest)) == set(quantities(WHOLE)) - {quantity}


def test_a_change_frees_a_value_before_one_after_and_a_time() -> None:
    changed = "armature_resistance"
    assert Explanation(changed=changed).names == (changed, changed + AFTER, changed + WHEN)
    assert len(WHOLE.names) == 1 + 2 + 1 + 3


def test_what_a_variant_fixes_is_not_free() -> None:
    loaded = Explanation().plus(LOAD)
    assert loaded.names == ("external_load.torque", "external_load.start")
    assert loaded.fixed == {"external_load.end": 0.0}


def test_the_order_in_which_it_was_grown_is_forgotten() -> None:
    one = Explanation(("spring_preload", "armature_resistance"), (STICTION, LAG))
    other = Explanation(("armature_resistance", "spring_preload"), (LAG, STICTION))
    assert one != other
    assert canonical(one, ORDER) == canonical(other, ORDER) is not None


@pytest.mark.parametrize(
    "twice",
    [
        Explanation(("spring_preload", "spring_preload")),
        Explanation(("spring_preload",), changed="spring_preload"),
        Explanation((), (LAG, LAG)),
        Explanation((), (Variant("viscous_friction", ("coefficient",)),)),
    ],
    ids=["drift", "drift and change", "effect", "effect that the actuator always has"],
)
def test_nothing_stands_in_an_explanation_twice(twice: Explanation) -> None:
    assert canonical(twice, ORDER) is None


def test_people_read_what_it_changes() -> None:
    assert Explanation().label == "nominal"
    assert WHOLE.label == "spring_preload + change of armature_resistance + static_friction + sensor_lag"
    assert Explanation((), (LOAD,)).label == "external_load (end 0)"
