"""What a recording can tell, against the ties of sliding motion that follow on paper."""

import pytest

from pierburg_ros.identification.fit import fit
from pierburg_ros.identification.identifiability import identifiability
from pierburg_ros.identification.identify import free_names
from pierburg_ros.identification.paper.lumps import fitted_lumps


@pytest.fixture(scope="module")
def findings(nominal, rich_recording):
    return identifiability(fit(nominal, [rich_recording], free_names(nominal)), [rich_recording])


def test_the_free_parameters_are_known(findings, nominal):
    for name in free_names(nominal):
        assert findings[name].identifiable
        assert findings[name].half_width < 0.01


def test_inertia_leaves_no_trace(findings):
    assert not findings["total_inertia"].identifiable
    assert "leaves no trace" in findings["total_inertia"].reason


def test_gear_ratio_looks_like_the_torque_constant(findings):
    assert findings["gear_ratio"].imitation == pytest.approx({"torque_constant": 1.0}, abs=1e-3)


def test_supply_voltage_looks_like_resistance_and_torque_constant(findings):
    # V moves only the gain; R moves (time constant, gain) by (-1, -1) and k_m by (2, 1): R -2 %, k_m -1 %.
    expected = {"armature_resistance": -2.0, "torque_constant": -1.0}
    assert findings["supply_voltage"].imitation == pytest.approx(expected, abs=0.01)
    assert "armature_resistance -2.00 %" in findings["supply_voltage"].reason


def test_the_scale_of_all_torques_is_open(findings):
    expected = {"armature_resistance": 1.0, "spring_preload": -1.0, "coulomb_friction": -1.0}
    assert findings["spring_stiffness"].imitation == pytest.approx(expected, abs=0.01)


def test_tied_parameters_leave_the_lumps_known(nominal, rich_recording):
    names = (*free_names(nominal), "supply_voltage", "spring_stiffness")
    fitted = fit(nominal, [rich_recording], names)
    told = identifiability(fitted, [rich_recording])
    assert not any(told[name].identifiable for name in names)
    assert fitted.ci95["armature_resistance"] == nominal.range("armature_resistance")
    for lump in fitted_lumps(fitted).values():
        assert lump.ci95 is not None
        assert lump.ci95[1] / lump.ci95[0] < 1.002
