"""docs/equations.md: what follows from the equations is what the simulator does."""

import math

import numpy as np
import pytest
from support.documentation import ROOT
from support.recordings import NOMINAL

from pierburg_ros.plant import Inputs, simulate

PAGE = (ROOT / "docs" / "equations.md").read_text(encoding="utf-8")
V = NOMINAL.values
BRAKING = (V["gear_ratio"] * V["torque_constant"]) ** 2 / V["armature_resistance"]
TIME_CONSTANT = BRAKING / V["spring_stiffness"]
STALL = V["gear_ratio"] * V["torque_constant"] * V["supply_voltage"] / V["armature_resistance"]
GAIN = STALL / V["spring_stiffness"]


def test_the_time_constants_are_those_of_the_valve():
    fast = V["total_inertia"] / BRAKING
    assert f"{fast * 1e6:.0f} us and {TIME_CONSTANT:.2f} s for the valve" in PAGE
    assert 4.5 < math.log10(TIME_CONSTANT / fast) < 5.0 and "nearly five orders" in PAGE


def test_a_sliding_shaft_follows_the_first_order_law():
    """Opening from rest under one duty that ends between the stops, in closed form."""
    time, duty = np.arange(0.0, 3.0, 0.002), 0.22
    end = GAIN * duty - (V["spring_preload"] + V["coulomb_friction"]) / V["spring_stiffness"]
    expected = end * (1.0 - np.exp(-time / TIME_CONSTANT))
    span = V["hall_voltage_open"] - V["hall_voltage_closed"]
    voltage = simulate(NOMINAL, Inputs(np.array([0.0]), np.array([duty])), time)
    angle = (voltage - V["hall_voltage_closed"]) / span * math.pi / 2
    assert 0.0 < end < math.pi / 2
    assert angle == pytest.approx(expected, abs=2e-4)
