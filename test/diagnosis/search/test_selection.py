"""A larger explanation needs more than chance, and beside an effect more than what simulators differ by."""

from dataclasses import replace

import pytest
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.fits import Fit, Search
from pierburg_ros.diagnosis.search.selection import (
    SIGNIFICANT,
    accounts_for_all,
    adequate,
    allowance,
    betters,
    complete,
    gain,
)

LAG = Variant("sensor_lag", ("time_constant",))
TRUE = {"sensor_lag.time_constant": 0.012}


def fitted(changes: dict[str, float], *explanations: Explanation) -> tuple[Search, list[Fit]]:
    """Fits to a recording of the nominal valve with `changes`."""
    search = Search(evidence_of([recording({**TRUE, **changes})], PIERBURG), NOMINAL)
    return search, [search.fit(explanation, TRUE) for explanation in explanations]


def test_what_simulators_differ_by_is_a_third_of_a_millivolt() -> None:
    search, (lag, drift) = fitted({}, Explanation((), (LAG,)), Explanation(("spring_preload",)))
    samples = lag.solution.residual.size
    assert allowance(lag, search.data) == pytest.approx(samples * (0.0003 / search.data.noise) ** 2, rel=0.01)
    assert allowance(drift, search.data) == 0.0


def test_a_drift_too_small_to_be_more_than_that_is_not_named_beside_an_effect() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    search, (lag, larger) = fitted({"spring_preload": 0.290028}, Explanation((), (LAG,)), both)
    assert gain(lag, larger) > SIGNIFICANT
    assert accounts_for_all(lag, search.data)
    assert not betters(larger, lag, search)


def test_a_plain_drift_beside_an_effect_betters_it() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    search, (lag, larger) = fitted({"spring_preload": 0.292}, Explanation((), (LAG,)), both)
    assert not accounts_for_all(lag, search.data)
    assert accounts_for_all(larger, search.data)
    assert betters(larger, lag, search)


def test_what_is_bent_to_the_training_samples_betters_nothing() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    search, (lag, larger) = fitted({"spring_preload": 0.292}, Explanation((), (LAG,)), both)
    elsewhere = replace(larger, model=larger.model.with_values({"spring_preload": 0.32}))
    assert gain(lag, elsewhere) == gain(lag, larger)
    assert not betters(elsewhere, lag, search)


def test_white_noise_larger_than_estimated_is_all_there_is_and_structure_is_not() -> None:
    data = evidence_of([recording({**TRUE, "spring_preload": 0.2901})], PIERBURG)
    low, explanation = replace(data, noise=0.0028), Explanation((), (LAG,))
    structured = Search(data, NOMINAL).fit(explanation, TRUE)
    noise = Search(low, NOMINAL).fit(replace(explanation, drifted=("spring_preload",)), TRUE)
    assert 1.03 < structured.ratio < noise.ratio < 1.1
    assert adequate(noise) and complete(noise)
    assert not adequate(structured) and not complete(structured)
