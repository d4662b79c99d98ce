"""A second look finds the values that a descent over a rough cost has missed."""

import pytest
from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.explore import FADING, Exploration
from pierburg_ros.diagnosis.search.fits import Search
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.estimation.refinement import polished

pytestmark = pytest.mark.search

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
VISCOUS = Variant("viscous_friction", ("coefficient",))


def test_reaches_the_noise_where_a_descent_stops_early() -> None:
    truth = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
    search = Search(evidence_of([recording(truth)], PIERBURG), NOMINAL)
    start = {"static_friction.breakaway_torque": 0.25, "static_friction.stribeck_velocity": 0.12}
    stopped = search.fit(Explanation((), (STICTION,)), start)
    found = polished(search, stopped)
    assert stopped.ratio > 2.0
    assert found.ratio < 1.03
    assert found.values["static_friction.breakaway_torque"] == pytest.approx(0.27, rel=0.03)


@pytest.mark.parametrize(
    "pair",
    [
        ("armature_resistance", "torque_constant"),
        ("armature_resistance", "supply_voltage"),
        ("torque_constant", "supply_voltage"),
    ],
)
def test_what_stands_for_viscous_friction_is_found_as_it_fades(pair: tuple[str, str]) -> None:
    """Viscous friction b at the shaft is (k_g k_m)^2 / R larger by b at the same k_g k_m V / R: an exact tie."""
    exploration = Exploration(evidence_of([recording({"viscous_friction.coefficient": 0.025})], PIERBURG), NOMINAL)
    best = exploration.add(Explanation((), (VISCOUS,)), {"viscous_friction.coefficient": 0.02})
    exploration.consider(Explanation(pair), VISCOUS, best)
    assert FADING[-1] == 0.0
    other = exploration.fits[Explanation(pair)]
    assert other.chi2 == pytest.approx(best.chi2, rel=1e-3)
    value = other.values
    braking = (37.3 * value["torque_constant"]) ** 2 / value["armature_resistance"]
    push = 37.3 * value["torque_constant"] * value["supply_voltage"] / value["armature_resistance"]
    assert braking == pytest.approx((37.3 * 0.022) ** 2 / 4.139 + 0.025, rel=1e-3)
    assert push == pytest.approx(37.3 * 0.022 * 13.5 / 4.139, rel=1e-3)


def test_what_stands_for_viscous_friction_beside_play_is_found_as_it_fades() -> None:
    truth = {"viscous_friction.coefficient": 0.025, "backlash.gap": 0.04, "backlash.motor_friction_share": 0.1}
    exploration = Exploration(evidence_of([recording(truth, duties=(-0.2, 0.36))], PIERBURG), NOMINAL)
    play = Variant("backlash", ("gap", "motor_friction_share"))
    best = exploration.add(Explanation((), (play, VISCOUS)), truth)
    other = Explanation(("armature_resistance", "torque_constant"), (play,))
    exploration.consider(other, VISCOUS, best)
    assert best.ratio < 1.03
    assert exploration.fits[other].ratio < 1.03
