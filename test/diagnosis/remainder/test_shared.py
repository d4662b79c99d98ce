"""Effects that several recordings share, judged on recordings left out."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from support.fits import found_among
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.remainder.shared import LeftOut, shared_effects
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation

TRUTH = {"viscous_friction.coefficient": 0.03, "sensor_lag.time_constant": 0.01}
Shared = tuple[Fit, dict[str, LeftOut]]
pytestmark = pytest.mark.search


def shared_by(changes: dict[str, float]) -> Shared:
    """What three recordings of the nominal valve with `changes` share."""
    data = data_on(*(recording(changes, duration=6.0, seed=seed) for seed in range(3)))
    found = found_among(data, Estimator(data, NOMINAL).fit(Explanation()))
    with ThreadPoolExecutor(2) as pool:
        return shared_effects(found, pool, lambda _: None)


@pytest.fixture(scope="module")
def shared() -> Shared:
    return shared_by(TRUTH)


def test_finds_the_effects_that_help_on_recordings_left_out(shared: Shared) -> None:
    fit, _ = shared
    assert sorted(fit.explanation.effects) == ["sensor_lag", "viscous_friction"]
    assert fit.ratio == pytest.approx(1.0, abs=0.05)
    for name, value in TRUTH.items():
        assert fit.values[name] == pytest.approx(value, rel=0.02)


def test_says_how_far_each_effect_helps_where_it_was_not_fitted(shared: Shared) -> None:
    fit, left_out = shared
    assert set(left_out) == set(fit.explanation.effects)
    for said in left_out.values():
        assert (said.helped, said.parts) == (3, 3)
        assert said.beside == pytest.approx(fit.ratio * 0.003, rel=0.05)
        assert said.without > 1.2 * said.beside


def test_believes_nothing_where_nothing_is_missing() -> None:
    fit, left_out = shared_by({})
    assert fit.explanation.effects == ()
    assert left_out == {}
    assert fit.ratio == pytest.approx(1.0, abs=0.05)
