"""Effects that several recordings share, judged on recordings left out."""

import numpy as np
import pytest
from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation
from pierburg_ros.diagnosis.search.explore import Exploration
from pierburg_ros.diagnosis.verdict.shared import Shared, select
from support.recordings import NOMINAL, PIERBURG, recording

pytestmark = pytest.mark.search

TRUTH = {"viscous_friction.coefficient": 0.03, "sensor_lag.time_constant": 0.01}


@pytest.fixture(scope="module")
def shared() -> Shared:
    recordings = [recording(TRUTH, duration=6.0, seed=seed) for seed in range(3)]
    exploration = Exploration(evidence_of(recordings, PIERBURG), NOMINAL)
    return select(exploration, exploration.search.fit(Explanation()))


def test_finds_the_effects_that_help_on_recordings_left_out(shared: Shared) -> None:
    assert sorted(shared.fit.explanation.effects) == ["sensor_lag", "viscous_friction"]
    assert shared.fit.ratio == pytest.approx(1.0, abs=0.05)
    for name, value in TRUTH.items():
        assert shared.fit.values[name] == pytest.approx(value, rel=0.02)


def test_says_how_far_each_effect_is_believed_and_why(shared: Shared) -> None:
    """Helping in three of three parts leaves the doubt of Laplace's rule: (3 + 1) / (3 + 2)."""
    assert set(shared.supports) == set(shared.fit.explanation.effects)
    for support in shared.supports.values():
        assert support.confidence == pytest.approx(0.8)
        assert "left out" in support.reason
        assert "3 of 3 parts" in support.reason


def test_believes_nothing_where_nothing_is_missing() -> None:
    recordings = [recording({}, duration=6.0, seed=seed) for seed in range(3)]
    exploration = Exploration(evidence_of(recordings, PIERBURG), NOMINAL)
    found = select(exploration, exploration.search.fit(Explanation()))
    assert found.fit.explanation.effects == ()
    assert found.supports == {}
    assert np.isclose(found.fit.ratio, 1.0, atol=0.05)
