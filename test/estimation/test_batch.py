"""Runs that share their inputs give, simulated together, what each gives by itself."""

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.evidence.stretches import leading_to, restarted
from pierburg_ros.estimation.batch import batches
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.rests import cut_at_rests
from pierburg_ros.estimation.run import Switch

MODELS = {
    "nominal": {},
    "play and lag of the sensor": {"sensor_hysteresis.width": 0.02, "sensor_lag.time_constant": 0.01},
    "a bent sensor": {"sensor_nonlinearity.amplitude": 0.02},
    "bristles": {"presliding.stiffness": 10.0, "presliding.damping": 0.02},
    "a load, heat and play": {
        "external_load.torque": 0.05,
        "external_load.start": 3.0,
        "thermal_resistance.thermal_resistance": 3.0,
        "thermal_resistance.heat_capacity": 20.0,
        "backlash.gap": 0.02,
    },
    "a late command": {"input_delay.delay": 0.02},
}
WAYS = {
    "whole": lambda data: data,
    "at rests": cut_at_rests,
    "in stretches": lambda data: restarted(data, 1.0),
    "in stretches that overlap": lambda data: leading_to(data, 1.0, 0.3),
}


@pytest.fixture(scope="module")
def whole() -> Data:
    """24 s of a valve that moves and rests."""
    return data_on(recording({}))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("way", WAYS)
def test_together_they_give_what_each_gives(whole: Data, way: str, model: str) -> None:
    data, changed = WAYS[way](whole), NOMINAL.with_values(MODELS[model])
    together = np.concatenate([batch.simulated(changed) for batch in batches(data.runs)])
    np.testing.assert_array_equal(together, np.concatenate([run.simulated(changed) for run in data.runs]))


def test_a_model_that_takes_over_does_so_in_each(whole: Data) -> None:
    runs, switch = cut_at_rests(whole).runs, Switch(NOMINAL.with_values({"coulomb_friction": 0.3}), 4.0)
    together = np.concatenate([batch.simulated(NOMINAL, switch) for batch in batches(runs)])
    np.testing.assert_array_equal(together, np.concatenate([run.simulated(NOMINAL, switch) for run in runs]))


def test_parts_of_one_recording_make_one_batch(whole: Data) -> None:
    parts = cut_at_rests(whole).runs
    assert len(parts) > 5
    assert [batch.runs for batch in batches(parts)] == [parts]
    assert [len(batch.runs) for batch in batches((*whole.runs, *data_on(recording({})).runs))] == [1, 1]
