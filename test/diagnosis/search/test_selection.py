"""A larger explanation needs more than chance, and beside an effect more than what simulators differ by."""

from dataclasses import replace

import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.selection import allowance, betters, gain, names_all, overlooks, tied
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.likelihood import EXPLAINED, SIGNIFICANT
from pierburg_ros.inference.explanation import Explanation, Variant

LAG = Variant("sensor_lag", ("time_constant",))
TRUE = {"sensor_lag.time_constant": 0.012}


def fitted(changes: dict[str, float], *explanations: Explanation) -> tuple[Estimator, list[Fit]]:
    """Fits to a recording of the nominal valve with `changes`."""
    estimator = Estimator(data_on(recording({**TRUE, **changes})), NOMINAL)
    return estimator, [estimator.fit(explanation, TRUE) for explanation in explanations]


def test_what_simulators_differ_by_is_a_third_of_a_millivolt() -> None:
    estimator, (lag, drift) = fitted({}, Explanation((), (LAG,)), Explanation(("spring_preload",)))
    samples = lag.solution.residual.size
    assert allowance(lag) == pytest.approx(samples * (0.0003 / estimator.data.noise) ** 2, rel=0.01)
    assert allowance(drift) == pytest.approx(0.0, abs=1e-9)


def test_a_drift_too_small_to_be_more_than_that_is_not_named_beside_an_effect() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    estimator, (lag, larger) = fitted({"spring_preload": 0.290028}, Explanation((), (LAG,)), both)
    assert gain(lag, larger) > SIGNIFICANT
    assert names_all(lag)
    assert not betters(larger, lag, estimator)


def test_a_plain_drift_beside_an_effect_betters_it() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    estimator, (lag, larger) = fitted({"spring_preload": 0.292}, Explanation((), (LAG,)), both)
    assert not names_all(lag)
    assert names_all(larger)
    assert betters(larger, lag, estimator)


def test_what_is_bent_to_the_training_samples_betters_nothing() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    estimator, (lag, larger) = fitted({"spring_preload": 0.292}, Explanation((), (LAG,)), both)
    elsewhere = replace(larger, model=larger.model.with_values({"spring_preload": 0.32}))
    assert gain(lag, elsewhere) == gain(lag, larger)
    assert not betters(elsewhere, lag, estimator)


def test_white_noise_larger_than_estimated_is_all_there_is_and_structure_is_not() -> None:
    data = data_on(recording({**TRUE, "spring_preload": 0.2901}))
    low, explanation = replace(data, noise=0.0028), Explanation((), (LAG,))
    structured = Estimator(data, NOMINAL).fit(explanation, TRUE)
    noise = Estimator(low, NOMINAL).fit(replace(explanation, drifted=("spring_preload",)), TRUE)
    assert structured.ratio < noise.ratio < EXPLAINED
    assert adequate(noise) and names_all(noise)
    assert not adequate(structured) and not names_all(structured)
    assert not adequate(Estimator(replace(data, noise=0.0026), NOMINAL).fit(noise.explanation, noise.values))


def test_an_error_that_lasts_is_all_there_is_where_the_noise_has_one() -> None:
    data = data_on(recording({"spring_preload": 0.2901}))
    nominal = Estimator(data, NOMINAL).fit(Explanation())
    assert nominal.ratio < EXPLAINED and not adequate(nominal)
    assert adequate(Estimator(replace(data, unlike=0.5 * data.noise), NOMINAL).fit(Explanation()))


def test_what_only_the_validation_samples_show_is_overlooked() -> None:
    load = {"external_load.torque": 0.06, "external_load.start": 3.2, "external_load.end": 3.7}
    data = data_on(recording(load))
    (run,) = data.runs
    during = (run.time > 3.0) & (run.time < 9.0)
    hidden = replace(data, runs=(replace(run, train=run.train & ~during, validation=during),))
    for given, expected in ((hidden, True), (data_on(recording({})), False)):
        estimator = Estimator(given, NOMINAL)
        nominal = estimator.fit(Explanation())
        assert adequate(nominal)
        assert overlooks(nominal, estimator) == expected


def test_only_known_fits_are_tied() -> None:
    """A model with a residual torque stands beside what was searched."""
    estimator = Estimator(data_on(recording({}, duration=5.0)), NOMINAL)
    assert tied(estimator.fit(Explanation()), [], estimator) == []
