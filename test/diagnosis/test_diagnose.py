"""From recordings to a diagnosis: what is refused, and a sensor that is not the nominal one."""

import pytest
from support.recordings import NOMINAL, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.diagnose import diagnose, evidence
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model


def test_another_actuator_is_refused() -> None:
    with pytest.raises(InputError, match=r"holds hall_voltage, but actuator xl330 measures position"):
        diagnose([recording({}, duration=5.0)], Model.nominal(read_actuator("xl330")))


def test_what_is_too_short_is_refused() -> None:
    with pytest.raises(InputError, match="too short"):
        diagnose([recording({}, duration=5.0), recording({}, duration=1.0)], NOMINAL)


def test_every_sample_trains_validates_or_tests() -> None:
    data = evidence([recording({}, duration=5.0), recording({}, duration=7.0, seed=1)], NOMINAL)
    assert len(data.runs) == 2
    assert data.train.any() and data.validation.any() and data.test.any()
    assert (data.train.astype(int) + data.validation + data.test == 1).all()


@pytest.mark.search
def test_a_sensor_whose_ends_are_known_to_differ_is_no_fault() -> None:
    """The recording begins with the valve half open: decoded by the nominal ends it would start 2 degrees off."""
    ends = {"hall_voltage_closed": 0.55, "hall_voltage_open": 4.4}
    result = diagnose([recording(ends).select(2.42, 14.0)], NOMINAL.with_values(ends))
    assert result.diagnosis.verdict == "consistent"
    assert result.diagnosis.fit.validation.final_rmse == pytest.approx(0.003, rel=0.05)
    assert result.model.values["hall_voltage_open"] == 4.4


def test_without_time_the_best_verdict_yet_is_given_and_marked():
    found = diagnose([recording({"pwm_deadband.width": 0.02}, duration=8.0)], NOMINAL, budget=0.01)
    assert found.diagnosis.stopped and "best verdict yet" in found.diagnosis.summary
    assert not found.diagnosis.ruled_out and not found.diagnosis.effects
