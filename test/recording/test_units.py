"""Units as maps write them, against their definitions."""

import math

import pytest

from pierburg_ros.recording.units import unit_of


@pytest.mark.parametrize(
    ("written", "factor", "measures"),
    [
        ("1", 1.0, "1"),
        ("percent", 0.01, "1"),
        ("%", 0.01, "1"),
        ("deg", math.pi / 180, "rad"),
        ("degree", math.pi / 180, "rad"),
        ("fraction", 1.0, "1"),
        ("mrad", 1e-3, "rad"),
        ("rev", 2 * math.pi, "rad"),
        ("rpm", math.pi / 30, "rad/s"),
        ("deg/s", math.pi / 180, "rad/s"),
        ("rev/s", 2 * math.pi, "rad/s"),
        ("mm", 1e-3, "m"),
        ("mm/s", 1e-3, "m/s"),
        ("mV", 1e-3, "V"),
        ("kV", 1e3, "V"),
        ("uA", 1e-6, "A"),
        ("µA", 1e-6, "A"),
        ("Nm", 1.0, "N.m"),
        ("N·m", 1.0, "N.m"),
        ("mN.m", 1e-3, "N.m"),
        ("mNm", 1e-3, "N.m"),
        ("N.mm", 1e-3, "N.m"),
        ("kN", 1e3, "N"),
        ("ms", 1e-3, "s"),
        ("°C", 1.0, "degC"),
        ("counts", 1.0, "V"),
        ("counts", 1.0, "rad"),
    ],
)
def test_a_unit_has_its_factor_and_measures_its_quantity(written, factor, measures):
    unit = unit_of(written)
    assert unit.factor == pytest.approx(factor, rel=1e-15)
    assert unit.measures(measures)


@pytest.mark.parametrize("written", ["", "volts", "furlong", "N m", "/s", "V/", "V..A", "mm m", "k", "x" * 500, "V^99"])
def test_what_is_no_unit_is_refused(written):
    with pytest.raises(ValueError, match="no unit"):
        unit_of(written)


@pytest.mark.parametrize(("written", "wanted"), [("V", "A"), ("deg", "1"), ("rad", "rad/s"), ("N", "N.m"), ("s", "1")])
def test_a_unit_of_something_else_does_not_measure_it(written, wanted):
    assert not unit_of(written).measures(wanted)
