"""Windows, limits and laws as the page shows them."""

from types import SimpleNamespace

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.report.allowed import bars
from pierburg_ros.diagnosis.report.characteristics import friction_torque, load_torque
from pierburg_ros.diagnosis.report.figures import apart
from pierburg_ros.diagnosis.report.places import Place, places
from pierburg_ros.diagnosis.report.tried import shortened
from pierburg_ros.diagnosis.schema import Location, RuledOut
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.plant import Model

NOMINAL = Model.nominal(read_actuator("pierburg"))


def test_neighbours_are_one_window_and_the_largest_share_comes_first():
    found = places([
        Location(start=1.0, end=1.5, share=0.1, regime="slow"),
        Location(start=9.0, end=9.5, share=0.3, regime="alone"),
        Location(start=1.54, end=2.0, share=0.25, regime="fast"),
    ])  # fmt: skip
    assert [(each.start, each.end, each.regime) for each in found] == [(1.0, 2.0, "fast"), (9.0, 9.5, "alone")]
    assert found[0].share == pytest.approx(0.35)


def test_limits_stand_beside_typical_sizes():
    typical = 0.4 * NOMINAL.values["coulomb_friction"]
    limit = NOMINAL.values["coulomb_friction"] + 0.5 * typical
    gap = RuledOut(id="backlash", parameter="gap", below=0.0015, unit="rad")
    found = bars([RuledOut(id="static_friction", parameter="breakaway_torque", below=limit, unit="N.m"), gap], NOMINAL)
    assert [bar.name for bar in found] == ["backlash", "static friction"]
    # as one meets it: play of 0.015 rad, and breaking loose at 40 % more than sliding
    assert [bar.share for bar in found] == pytest.approx([0.1, 0.5], rel=0.01)
    assert found[0].text == "below 0.0015 rad"


def test_all_parameters_re_estimated_have_one_name():
    every = ("armature_resistance", "spring_preload", "spring_stiffness")
    sag = Variant("supply_sag", ("source_resistance",))
    recalibrated, sagging, single = (
        SimpleNamespace(explanation=each)
        for each in (Explanation(every), Explanation(every, (sag,)), Explanation(every[:1]))
    )
    assert shortened(sagging, recalibrated) == "parameters_re-estimated+supply_sag"
    assert shortened(recalibrated, recalibrated) == "parameters_re-estimated"
    assert shortened(single, recalibrated) == shortened(single, single) == "armature_resistance"


def test_two_limits_of_one_effect_have_a_bar_each():
    """Bars of one name would stand one behind the other."""
    both = [RuledOut(id="external_load", parameter=name, below=0.001, unit="N.m") for name in ("torque", "amplitude")]
    assert {bar.name for bar in bars(both, NOMINAL)} == {"external load: torque", "external load: amplitude"}


def test_numbers_of_windows_keep_apart():
    time = np.linspace(0.0, 60.0, 10)
    near, far = Place(10.0, 10.5, 0.3, ""), Place(20.0, 20.5, 0.2, "")
    assert apart([near], time) and apart([near, far], time)
    assert not apart([near, far, Place(11.0, 11.5, 0.1, "")], time)


def test_friction_over_velocity_is_the_stribeck_curve():
    """T_c + (T_b - T_c) exp(-(w / w_s)^2) against the motion, T_b where it stands (section 7 of docs/contract.md)."""
    model = NOMINAL.with_values({"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1})
    velocity = np.array([-0.2, -0.05, -0.0, np.nan, 0.0, 0.05, 0.2])
    level = 0.2007 + (0.27 - 0.2007) * np.exp(-((velocity / 0.1) ** 2))
    sign = np.array([-1.0, -1.0, -1.0, np.nan, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(friction_torque(model, velocity, 0.5), sign * level, rtol=1e-12)


def test_friction_that_grows_with_the_motor_torque_solves_its_own_balance():
    """Sliding up, T_m = load + T_c + c T_m; down, T_m = load - T_c - c T_m."""
    model = NOMINAL.with_values({"load_dependent_friction.coefficient": 0.1})
    load, sliding = 0.29 + 0.1419 * 0.5, 0.2007
    up, down = (load + sliding) / (1.0 - 0.1), (load - sliding) / (1.0 + 0.1)
    found = friction_torque(model, np.array([-1.0, np.nan, 1.0]), 0.5)
    np.testing.assert_allclose(found[[0, 2]], [-(sliding + 0.1 * down), sliding + 0.1 * up], rtol=1e-6)


def test_load_over_angle_is_spring_and_preload():
    angle = np.array([0.0, 0.5, 1.5])
    np.testing.assert_allclose(load_torque(NOMINAL, angle), 0.29 + 0.1419 * angle, rtol=1e-12)
