"""The declaration of the controller's parameters."""

import math

import pytest

from pierburg_ros.control import SETTINGS, Settings
from pierburg_ros.errors import InputError


def test_every_setting_says_what_it_is_and_defaults_within_its_range():
    assert [each.name for each in SETTINGS] == list(Settings.__dataclass_fields__)
    for each in SETTINGS:
        assert each.meaning and each.unit
        assert each.minimum <= each.default <= each.maximum


@pytest.mark.parametrize("value", [math.nan, math.inf, -1.0, 101.0, "fast", True, None])
def test_refuses_what_is_not_a_number_in_range(value):
    with pytest.raises(InputError, match=r"proportional_gain is .*; expected (0 to 100|a number)"):
        Settings(proportional_gain=value)


def test_integers_are_numbers():
    assert Settings(proportional_gain=2).record().proportional_gain == 2.0


def test_refuses_output_sets_out_of_order():
    with pytest.raises(InputError, match="rising order"):
        Settings(positive=0.5, positive_big=0.5)


def test_refuses_a_sensor_that_falls():
    with pytest.raises(InputError, match="hall_voltage_closed is not below hall_voltage_open"):
        Settings(hall_voltage_closed=4.6)


def test_refuses_a_setting_it_does_not_have():
    with pytest.raises(InputError, match="no setting 'gain'; it has proportional_gain"):
        Settings().with_values({"gain": 1.0})


def test_coupled_settings_are_checked_together():
    moved = Settings().with_values({"positive": 0.3, "positive_big": 0.4})
    assert (moved.positive, moved.positive_big) == (0.3, 0.4)


def test_the_record_holds_every_setting():
    settings = Settings(integral_gain=3.5)
    record = settings.record()
    assert {name: float(record[name]) for name in record.dtype.names} == vars(settings)
