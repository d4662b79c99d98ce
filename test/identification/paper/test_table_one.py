"""The audit of Table I against numbers worked out from the paper's rows."""

import pytest

from pierburg_ros.identification.paper.table_one import audit, derive


def test_what_the_primitive_rows_imply(nominal):
    found = derive(nominal)
    assert found.natural_frequency == pytest.approx(240.16, abs=0.01)
    assert found.damping_ratio == pytest.approx(137.68, abs=0.01)
    assert found.gain == pytest.approx(1.397, abs=0.001)
    assert found.slow_pole == pytest.approx(0.872, abs=0.001)
    assert found.fast_pole == pytest.approx(66_000, rel=0.01)
    assert found.inertia_time == pytest.approx(15e-6, rel=0.02)


def test_supply_voltage_that_the_steps_allow(nominal):
    found = derive(nominal)
    assert found.supply_low == pytest.approx(12.375, abs=0.001)
    assert found.supply_high == pytest.approx(15.0, abs=0.01)


def test_the_audit_says_that_the_printed_gain_does_not_follow(nominal):
    rows = {check.row: check for check in audit(nominal)}
    assert "1.397" in rows["K"].follows
    assert "does not follow" in rows["K"].verdict
    assert rows["omega_n"].verdict.startswith("follows")
    assert rows["xi"].verdict.startswith("follows")
    assert "not identifiable" in rows["J_t"].verdict
    assert "12.375 V < V" in rows["supply voltage"].follows


def test_the_numbers_are_computed_from_the_model(nominal):
    stiffer = nominal.with_values({"spring_stiffness": 2 * 0.1419})
    rows = {check.row: check for check in audit(stiffer)}
    assert "0.6986 rad/V" in rows["K"].follows
