"""A linear step tells what an addition promises, and what is missing beside a part of the truth promises most."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.screening import Candidate, most_promising, screened
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant

pytestmark = pytest.mark.search

LAG = Variant("sensor_lag", ("time_constant",))
PRELOAD = Explanation(("spring_preload",))
BOTH = {"sensor_lag.time_constant": 0.01, "spring_preload": 0.295}


def candidates_on(data: Data, explanation: Explanation) -> list[Candidate]:
    whole = Estimator(data, NOMINAL)
    with ThreadPoolExecutor(2) as pool:
        return screened(whole.fit(explanation), whole, drifting(NOMINAL), pool, lambda _: None)


@pytest.mark.parametrize("seed", [PRELOAD, Explanation((), (LAG,))], ids=lambda seed: seed.label)
def test_what_is_missing_beside_a_part_of_the_truth_promises_most(seed: Explanation) -> None:
    candidates = candidates_on(data_on(recording(BOTH)), seed)
    (best,) = most_promising(candidates, 1)
    assert best.explanation == Explanation(("spring_preload",), (LAG,))
    assert 0.95 < best.promise < 0.5 * best.base.ratio


def test_every_addition_is_looked_at_once() -> None:
    candidates = candidates_on(data_on(recording(BOTH, duration=6.0)), PRELOAD)
    explanations = [candidate.explanation for candidate in candidates]
    assert len(set(explanations)) == len(explanations)
    assert all(explanation.size == 2 for explanation in explanations)
    drifts = {candidate.addition for candidate in candidates if candidate.drifts}
    assert drifts == set(drifting(NOMINAL)) - {"spring_preload"}


def test_a_change_in_the_middle_is_looked_for_alone_and_in_one_recording() -> None:
    first, second = (recording({}, duration=6.0, seed=seed) for seed in range(2))
    for data, seed, expected in (
        (data_on(first), Explanation(), True),
        (data_on(first, second), Explanation(), False),
        (data_on(first), Explanation((), (LAG,)), False),
    ):
        assert any(candidate.changes for candidate in candidates_on(data, seed)) == expected


def test_beside_what_accounts_for_all_only_what_promises_a_gain_is_fitted() -> None:
    candidates = candidates_on(data_on(recording({}, duration=12.0)), Explanation())
    assert any(candidate.changes for candidate in candidates)
    assert not any(candidate.starts for candidate in candidates if candidate.changes or candidate.drifts)
    drifted = candidates_on(data_on(recording({"spring_preload": 0.292}, duration=12.0)), Explanation())
    assert all(candidate.starts for candidate in drifted if candidate.addition == "spring_preload")


def test_what_shows_late_is_looked_at_in_whole_recordings(monkeypatch: pytest.MonkeyPatch) -> None:
    """A weaker supply from 8 s on leaves no mark in the first four seconds, one from the start does."""
    monkeypatch.setattr("pierburg_ros.estimation.data.FIRST_PART", 4.0 / NOMINAL.scales.time)
    plain = data_on(recording({}, duration=12.0))
    (run,) = plain.runs
    weak = run.simulated(NOMINAL.with_values({"supply_voltage": 12.5}))
    for begin, size in ((8.0, run.time.size), (0.0, 2000)):
        made = recording({}, duration=12.0)
        object.__setattr__(made, "measured", np.where(run.time < begin, made.measured, weak))
        looked = {candidate.base.solution.residual.size for candidate in candidates_on(data_on(made), Explanation())}
        assert max(looked) == pytest.approx(0.75 * 6000, rel=0.02)
        assert min(looked) == pytest.approx(0.75 * size, rel=0.02 if size == 6000 else 0.3)
