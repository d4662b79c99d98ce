"""Explanations: what they change, and how many quantities that is."""

import pytest

from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant, quantities, without

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
LAG = Variant("sensor_lag", ("time_constant",))
LOAD = Variant("external_load", ("torque", "start"), (("end", 0.0),))
WHOLE = Explanation(("spring_preload",), (STICTION, LAG), "armature_resistance")


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
