"""Effects that several recordings share, judged on recordings left out."""

from types import SimpleNamespace

import pytest
from support.fits import found_among
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.diagnosis.remainder.left_out import LeftOut, folds_of
from pierburg_ros.diagnosis.remainder.shared import Bench, Round, Shared, shared_effects, thinned, undrifted
from pierburg_ros.estimation.data import all_training
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

TRUTH = {"viscous_friction.coefficient": 0.03, "sensor_lag.time_constant": 0.01}
pytestmark = pytest.mark.search


def shared_by(changes: dict[str, float]) -> Shared:
    """What three recordings of the nominal valve with `changes` share."""
    data = data_on(*(recording(changes, duration=6.0, seed=seed) for seed in range(3)))
    found = found_among(data, Estimator(data, NOMINAL).fit(Explanation()))
    return shared_effects(found, lambda _: None)


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
        assert said.without > 1.2 * said.beside
    first, last = (left_out[variant.effect] for variant in fit.explanation.variants)
    assert first.beside == pytest.approx(last.without)
    assert last.beside == pytest.approx(fit.ratio * 0.003, rel=0.05)


def test_after_an_interrupt_stands_what_had_been_added_by_then() -> None:
    data = data_on(*(recording(TRUTH, duration=6.0, seed=seed) for seed in range(3)))
    found = found_among(data, Estimator(data, NOMINAL).fit(Explanation()))
    seen: list[str] = []

    def interrupted_at_the_second(label: str) -> None:
        seen.append(label)
        if len(seen) == 2:
            raise KeyboardInterrupt

    fit, left_out = shared_effects(found, interrupted_at_the_second)
    assert fit.explanation.effects == tuple(left_out)
    assert len(left_out) == 1


def test_what_only_stood_in_is_taken_out_again() -> None:
    """A dead band that came first has nothing left to do beside the lag that acts."""
    data = all_training(data_on(*(recording(TRUTH, duration=6.0, seed=seed) for seed in range(3))))
    ways = (("pwm_deadband", "width"), ("viscous_friction", "coefficient"), ("sensor_lag", "time_constant"))
    whole = Explanation(variants=tuple(Variant(effect, (parameter,)) for effect, parameter in ways))
    with workers(1) as pool:
        bench = Bench(data, folds_of(data), NOMINAL, pool)
        fit = bench.settled(whole, {**TRUTH, "pwm_deadband.width": 0.01})
        said = {effect: LeftOut(2.0, 1.0, 3, 3) for effect, _ in ways}
        left = thinned(bench, Round(fit, bench.parts(fit), said), candidates=20)
    assert left.fit.explanation.effects == ("viscous_friction", "sensor_lag") == tuple(left.said)


def test_what_drifts_starts_nominal_also_where_it_belongs_to_an_effect() -> None:
    """Beside a missing effect the friction that a servo always has has bent as any parameter."""
    servo = Model.nominal(read_actuator("xl330"))
    drifted = ("torque_constant", "viscous_friction.coefficient")
    bent = {**servo.values, "torque_constant": 0.5, "viscous_friction.coefficient": 0.1, "backlash.gap": 0.02}
    fit = SimpleNamespace(explanation=Explanation(drifted, (Variant("backlash", ("gap",)),)), values=bent)
    assert undrifted(fit, servo) == {**servo.values, "backlash.gap": 0.02}


def test_no_time_at_all_is_said() -> None:
    data = data_on(*(recording({}, duration=6.0, seed=seed) for seed in range(3)))
    found = found_among(data, Estimator(data, NOMINAL).fit(Explanation()))
    with pytest.raises(OutOfTime):
        shared_effects(found, lambda _: None, deadline=Deadline(0.0))


def test_believes_nothing_where_nothing_is_missing() -> None:
    fit, left_out = shared_by({})
    assert fit.explanation.effects == ()
    assert left_out == {}
    assert fit.ratio == pytest.approx(1.0, abs=0.05)
