"""What a standard excitation tells of a description agrees with the ties that its equations have."""

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.description.told import told
from pierburg_ros.plant import Model


def test_finds_the_exact_ties_of_the_valve():
    found = told(Model.nominal(read_actuator("pierburg")))
    assert found["gear_ratio"].imitation == pytest.approx({"torque_constant": 1.0}, rel=1e-3)
    supply = {"armature_resistance": -2.0, "torque_constant": -1.0}
    assert found["supply_voltage"].imitation == pytest.approx(supply, rel=1e-3)
    assert not found["total_inertia"].identifiable and "no trace" in found["total_inertia"].reason
    assert found["coulomb_friction"].identifiable


@pytest.mark.parametrize("name", ["ak80", "odrive"])
def test_covers_other_drives(name):
    found = told(Model.nominal(read_actuator(name)))
    tied = {"ak80": "gravity_torque", "odrive": "torque_constant"}[name]
    assert not found[tied].identifiable and "tied" in found[tied].reason
    assert found["total_inertia"].identifiable
