"""diagnosis.json: the contract's fields, and null where a number does not exist."""

import json
import math

import pytest
from pydantic import ValidationError

from pierburg_ros.diagnosis.schema import (
    DataQuality,
    Diagnosis,
    Errors,
    Estimate,
    FitQuality,
    Location,
    Regime,
    TorqueOverTime,
)

QUALITY = DataQuality(rate=500.0, jitter=0.0, gaps=0, saturated_share=0.0, stops_touched=[], excited="nothing")
NOTHING = Errors(nominal_rmse=0.2, recalibrated_rmse=math.nan, final_rmse=math.inf)
CONTRACT = {
    "schema", "recordings", "quantity", "unit", "input", "motion", "verdict", "summary", "model_of", "effort",
    "effects", "doubted", "re_estimated_share", "parameters", "changes", "locations", "regimes", "simulation", "fit",
    "candidates", "not_testable", "cannot_act", "ruled_out", "remaining", "excluded", "residual_torque",
    "data_quality", "input_faults", "advice",
}  # fmt: skip


def document(**changes) -> Diagnosis:
    fields = {
        "recordings": ["train.mcap"],
        "quantity": "hall_voltage",
        "unit": "V",
        "verdict": "consistent",
        "summary": "all is well",
        "fit": FitQuality(noise_floor=0.004, training=NOTHING, validation=NOTHING),
        "data_quality": QUALITY,
    }
    return Diagnosis(**{**fields, **changes})


def test_has_the_fields_of_the_contract(tmp_path):
    document().write(tmp_path / "diagnosis.json")
    content = json.loads((tmp_path / "diagnosis.json").read_text())
    assert set(content) == CONTRACT
    assert content["schema"] == 3 and content["residual_torque"] is None


def test_a_number_that_does_not_exist_is_null():
    training = json.loads(document().text())["fit"]["training"]
    assert training == {"nominal_rmse": 0.2, "recalibrated_rmse": None, "final_rmse": None}
    assert Estimate(value=1.0, unit="ohm", ci95=(0.9, math.inf), identifiable=False).ci95 is None
    assert TorqueOverTime(time=[0.0, 1.0], torque=[math.nan, 0.1]).torque == [None, 0.1]


@pytest.mark.parametrize("text", ["NaN", "Infinity"])
def test_never_writes_what_json_lacks(text):
    regime = {"variable": "angle", "unit": "rad", "share_of_residual": 0.5, "share_of_time": 0.1}
    assert text not in document(regimes=[Regime(**regime, range=(0.0, 1.0), chance=math.nan)]).text()
    with pytest.raises(ValidationError):
        Regime(**regime, range=(0.0, math.inf))


def test_is_read_as_it_was_written(tmp_path):
    place = Location(start=1.0, end=1.5, share=0.4, regime="reversal near 20 degrees")
    written = document(locations=[place], verdict="unexplained")
    written.write(tmp_path / "diagnosis.json")
    assert Diagnosis.read(tmp_path / "diagnosis.json") == written


def test_more_windows_than_the_contract_allows_are_refused():
    place = Location(start=1.0, end=1.5, share=0.0, regime="")
    with pytest.raises(ValidationError, match="20"):
        document(locations=[place] * 21)
