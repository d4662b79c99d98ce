"""Quantities that recordings support although something remains; none where only that is there."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, disturbed, recording

from pierburg_ros.deadline import OutOfTime
from pierburg_ros.diagnosis.search import supported as module
from pierburg_ros.diagnosis.search import weighing
from pierburg_ros.diagnosis.search.belief import PROBABLE
from pierburg_ros.diagnosis.search.growing import FOLLOWED
from pierburg_ros.diagnosis.search.scored import scored, settled, unseen
from pierburg_ros.diagnosis.search.supported import Beside, confirmed_beside, likelier, supported, told_apart
from pierburg_ros.diagnosis.search.weighing import Supported, Weighing, Weight, unconfirmed
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.workers import workers

DELAY = Variant("input_delay", ("delay",))
ROUND = 2 * FOLLOWED
"""How many additions are fitted before one is chosen, some in each of two ways."""


class Inline(Executor):
    """Does what it is asked at once, without other processes."""

    def map(self, function, *arguments, **_):
        return map(function, *arguments)


def beginning(data: Data) -> Beside:
    """Nothing is known beside what the nominal model leaves."""
    nominal = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    return Beside(nominal, nominal.left, Supported(NOMINAL, nominal, {}))


def found_in(changes: dict[str, float], seed: int = 0) -> Supported | None:
    data = data_on(disturbed(changes, seed))
    with workers(1) as pool:
        return named_in(supported(data, NOMINAL, (), pool, lambda _: None), data)


def named_in(beside: Beside, data: Data) -> Supported | None:
    with workers(1) as pool:
        named = told_apart(beside.confirmed, Weighing(data, NOMINAL, pool), lambda _: None)
    return named if named.weights else None


def test_an_effect_is_named_beside_what_no_effect_makes():
    found = found_in({"input_delay.delay": 0.02})
    assert found is not None and found.scored.fit.explanation.effects == ("input_delay",)
    assert found.scored.fit.values["input_delay.delay"] == pytest.approx(0.02, abs=0.001)
    assert found.scored.discrepancy.size > 3.0


def test_what_is_confirmed_when_the_time_is_over_is_kept():
    """The second round is not finished."""
    data, told = data_on(disturbed({"input_delay.delay": 0.02}, 0)), list[str]()

    def tell(what: str) -> None:
        told.append(what)
        if len(told) > ROUND:
            raise OutOfTime

    beside = supported(data, NOMINAL, (), Inline(), tell)
    assert beside.stopped and set(beside.confirmed.weights) == {DELAY}
    told.extend([""] * ROUND)
    assert supported(data, NOMINAL, (), Inline(), tell).confirmed.weights == {}


def test_nothing_is_named_where_only_that_is_there():
    assert found_in({}, seed=1) is None


def test_what_a_search_has_found_is_heard_where_it_is_likelier():
    """Nothing was added one by one; the search has the delay, or a parameter that gains next to nothing."""
    data = data_on(disturbed({"input_delay.delay": 0.02}, 0))
    estimator = Estimator(data, NOMINAL)
    nominal = scored(data, estimator.at(Explanation()))
    nothing = Beside(nominal, nominal.left, Supported(NOMINAL, nominal, {}))
    late = estimator.fit(Explanation(variants=(DELAY,)), {"input_delay.delay": 0.018})
    other = estimator.fit(Explanation(("supply_voltage",)))
    with workers(1) as pool:
        heard = likelier(nothing, late, Weighing(data, NOMINAL, pool))
        assert likelier(nothing, other, Weighing(data, NOMINAL, pool)) is nothing
    assert set(heard.confirmed.weights) == {DELAY} and heard.begun == nothing.begun


def test_what_a_search_knows_is_taken_where_no_quantity_leads_to_it(monkeypatch: pytest.MonkeyPatch):
    """Of each size what leaves least; a change in the middle is none of it."""
    data = data_on(disturbed({"input_delay.delay": 0.02}, 0))
    estimator = Estimator(data, NOMINAL)
    late = estimator.fit(Explanation(variants=(DELAY,)), {"input_delay.delay": 0.018})
    other = estimator.fit(Explanation(("supply_voltage",)))
    changed = replace(late, explanation=Explanation(changed="supply_voltage"), values=other.values)
    monkeypatch.setattr(module, "grown", lambda *_: [])
    with workers(1) as pool:
        beside = supported(data, NOMINAL, [other, late, changed], pool, lambda _: None)
    assert beside.reached.fit.explanation == late.explanation
    assert set(beside.confirmed.weights) == {DELAY}


def test_what_a_likelier_explanation_does_without_is_no_longer_told(monkeypatch: pytest.MonkeyPatch):
    """A lag stood for a delay, which is not confirmed itself: the lag goes all the same."""
    lag = Variant("sensor_lag", ("time_constant",))
    data = data_on(disturbed({"input_delay.delay": 0.02}, 0))
    estimator = Estimator(data, NOMINAL)
    values = {"sensor_lag.time_constant": 0.01, "input_delay.delay": 0.02}
    first, then = (
        Supported(NOMINAL, scored(data, estimator.at(Explanation((), (each,)), values)), {each: Weight(100.0, 0.0)})
        for each in (lag, DELAY)
    )
    monkeypatch.setattr(module, "_approached", lambda *_: iter((first, then)))
    refused = {id(then): beginning(data).confirmed}
    monkeypatch.setattr(Weighing, "heard", lambda _, told: refused.get(id(told), told))
    beside = supported(data, NOMINAL, (), Inline(), lambda _: None)
    assert beside.reached is then.scored and beside.confirmed.weights == {}


def test_more_may_remain_on_unseen_samples_than_where_it_was_fitted():
    """Sixty times the noise there, next to nothing where the fit was made: a delay is as likely as before."""
    clean = recording({"input_delay.delay": 0.005}, duration=16.0)
    ends = np.flatnonzero(np.diff(data_on(clean).validation.astype(int)))
    swell = np.zeros(clean.time.size)
    for start, end in zip(ends[::2], ends[1::2], strict=False):
        swell[start:end] = np.sin(np.linspace(0.0, np.pi, end - start)) ** 2
    data = data_on(replace(clean, measured=clean.measured + 60.0 * NOISE * swell))
    estimator = Estimator(data, NOMINAL)
    late = estimator.at(Explanation(variants=(DELAY,)), {"input_delay.delay": 0.005})
    assert unseen(data, late) < unseen(data, estimator.at(Explanation()))


@pytest.mark.parametrize(("really", "confirmed"), [({"input_delay.delay": 0.02}, True), ({}, False)])
def test_an_effect_found_elsewhere_is_confirmed_beside_what_remains(really: dict[str, float], confirmed: bool):
    data = data_on(disturbed(really, 0))
    late = Estimator(data, NOMINAL).fit(Explanation(variants=(DELAY,)), {"input_delay.delay": 0.018})
    with workers(1) as pool:
        assert confirmed_beside(late, Weighing(data, NOMINAL, pool), lambda _: None) == confirmed


def test_a_quantity_carries_what_it_gains_of_that_and_what_is_left():
    assert Weight(300.0, 100.0).carried == pytest.approx(0.75)
    assert Weight(-5.0, 100.0).carried == 0.0
    assert Weight(100.0, -5.0).carried == 1.0


def test_of_several_effects_each_carries_its_share_of_what_there_is_without_any():
    """Half of what the others leave, but little beside what these explain."""
    assert Weight(100.0, 100.0, bare=1000.0).carried == pytest.approx(0.1)
    assert Weight(100.0, 100.0, bare=150.0).carried == pytest.approx(0.5)


def test_a_drift_that_may_stand_in_for_effects_takes_none_of_their_evidence():
    """Without them a nominal supply leaves what the nominal model does, however well another one would do instead."""
    band = Variant("pwm_deadband", ("width",))
    data = data_on(disturbed({"input_delay.delay": 0.02, "pwm_deadband.width": 0.03}, 0))
    values = {"supply_voltage": 13.5, "input_delay.delay": 0.02, "pwm_deadband.width": 0.03}
    fit = Estimator(data, NOMINAL).at(Explanation(("supply_voltage",), (DELAY, band)), values)
    weighing_it = Weighing(data, NOMINAL, Inline())
    weights = weighing_it.weighed(scored(data, fit)).weights
    assert weights[DELAY].bare == weights[band].bare == pytest.approx(beginning(data).begun)
    assert weighing_it.lacking(scored(data, fit), DELAY, band).left < weights[DELAY].bare - 60.0


def test_a_quantity_is_confirmed_by_what_unseen_samples_gain():
    there, bent = (Weight(300.0, 100.0, unseen, 0.9) for unseen in (45.0, -5.0))
    assert there.confirmed and not bent.confirmed
    assert not unconfirmed(DELAY, there) and unconfirmed(DELAY, bent)
    assert unconfirmed(DELAY, replace(there, plausible=False))
    assert Weight(300.0, 100.0).confirmed and Weight(300.0, 100.0).confidence == pytest.approx(0.75)


def test_what_unseen_samples_confirm_is_not_probable_where_it_explains_little():
    """As a supply that sags gains 134 on practice-20, where a spring relaxes, and removes 3 % of the squared error."""
    little, much = (Weight(gain, 600.0, 40.0, explains) for gain, explains in ((30.0, 0.03), (900.0, 0.8)))
    assert little.confirmed and unconfirmed(DELAY, little) and not unconfirmed(DELAY, much)
    assert unconfirmed("supply_voltage", little) and not unconfirmed("supply_voltage", replace(much, explains=0.95))


def test_an_effect_is_less_probable_the_more_its_best_replacement_gains():
    alone, nearly, outdone = (Weight(600.0, 500.0, 90.0, 0.6, apart=apart).confidence for apart in (1.0, 0.1, -1.0))
    assert alone > PROBABLE > nearly > outdone > 0.0


@pytest.mark.parametrize(("probable", "named"), [(0.0, True), (1.01, False)])
def test_an_effect_that_is_not_probable_is_given_up_and_told_as_doubted(monkeypatch, probable: float, named: bool):
    data = data_on(disturbed({"input_delay.delay": 0.02}, seed=0))
    fit = Estimator(data, NOMINAL).at(Explanation((), (DELAY,)), {"input_delay.delay": 0.02})
    weighing_it = Weighing(data, NOMINAL, Inline())
    confirmed = likelier(beginning(data), fit, weighing_it).confirmed
    assert set(confirmed.weights) == {DELAY}
    monkeypatch.setattr(module, "PROBABLE", probable)
    told = told_apart(confirmed, weighing_it, lambda _: None)
    assert (DELAY in told.weights) is named and ("input_delay" in told.doubted) is not named
    judged = next(iter(told.weights.values())) if named else told.doubted["input_delay"]
    assert judged.apart is not None and 0.3 < judged.apart <= 1.0 and judged.confidence > 0.9


def test_what_the_others_make_no_model_without_stays(monkeypatch: pytest.MonkeyPatch):
    """As friction that breaks loose below the one that slides."""
    data = data_on(disturbed({"input_delay.delay": 0.02}, seed=0))
    late = scored(data, Estimator(data, NOMINAL).at(Explanation((), (DELAY,)), {"input_delay.delay": 0.02}))
    told, weighing_it = Supported(NOMINAL, late, {DELAY: Weight(0.0, 100.0)}), Weighing(data, NOMINAL, Inline())

    def refuse(*_: object) -> None:
        raise InputError("no such model")

    monkeypatch.setattr(Estimator, "fit", refuse)
    assert weighing_it.thinned(told, lambda *_: True) is told


def test_the_last_effect_whose_events_jump_is_given_up_only_after_a_search_for_other_minima(monkeypatch):
    """A delay that stopped at nothing; the search for its other minima, made once, leads to the true one."""
    data, asked = data_on(disturbed({"input_delay.delay": 0.02}, seed=0)), list[Explanation]()
    explanation, estimator = Explanation((), (DELAY,)), Estimator(data, NOMINAL)
    told = Supported(
        NOMINAL, scored(data, estimator.at(explanation, {"input_delay.delay": 0.0})), {DELAY: Weight(0.0, 100.0)}
    )

    def lead(beside: Estimator, fit: Fit) -> Fit:
        asked.append(fit.explanation)
        return beside.at(fit.explanation, {"input_delay.delay": 0.02})

    monkeypatch.setattr(weighing, "lowered", lead)
    weighing_it = Weighing(data, NOMINAL, Inline())
    heard = weighing_it.heard(told)
    assert set(heard.weights) == {DELAY} and asked == [explanation]
    assert heard.scored.fit.values["input_delay.delay"] == pytest.approx(0.02, abs=0.002)
    assert not weighing_it.heard(told).weights and asked == [explanation]


def test_what_is_left_without_a_quantity_is_fitted_again_from_likelier_values():
    """First beside a drift from next to no delay, then from the true one."""
    data, rest = data_on(disturbed({"input_delay.delay": 0.02}, seed=0)), Explanation((), (DELAY,))
    estimator, both = Estimator(data, NOMINAL), Explanation(("supply_voltage",), (DELAY,))
    slow, true = (
        scored(data, estimator.at(both, {"supply_voltage": 13.5, "input_delay.delay": delay})) for delay in (2e-4, 0.02)
    )
    weighing_it = Weighing(data, NOMINAL, Inline())
    first, again = (weighing_it.lacking(each, "supply_voltage") for each in (slow, true))
    assert first.fit.explanation == again.fit.explanation == rest and again.cost <= first.cost
    assert again.fit.values["input_delay.delay"] == pytest.approx(0.02, abs=0.002)


def test_values_that_no_actuator_has_are_not_heard():
    """However likely they make it: a Stribeck velocity of 30 rad/s is that of no valve."""
    data = data_on(disturbed({"static_friction.breakaway_torque": 0.3, "static_friction.stribeck_velocity": 30.0}, 0))
    sticks = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
    values = {"static_friction.breakaway_torque": 0.3, "static_friction.stribeck_velocity": 30.0}
    fit = Estimator(data, NOMINAL).at(Explanation((), (sticks,)), values)
    begin = beginning(data)
    assert settled(data, NOMINAL, fit).cost < begin.reached.cost - 1000.0
    assert likelier(begin, fit, Weighing(data, NOMINAL, Inline())) is begin
    assert not confirmed_beside(fit, Weighing(data, NOMINAL, Inline()), lambda _: None)


@pytest.mark.parametrize(("delay", "told"), [(0.0005, True), (0.02, False)])
def test_what_gains_almost_as_much_is_told_with_the_name(delay, told):
    """A delay of half a millisecond is hardly told from a lag of as much; one of 20 ms is."""
    data = data_on(disturbed({"input_delay.delay": delay}, seed=0))
    fit = Estimator(data, NOMINAL).at(Explanation((), (DELAY,)), {"input_delay.delay": delay})
    best = settled(data, NOMINAL, fit)
    confirmed = Supported(NOMINAL, best, {DELAY: Weight(100.0, 0.0, 100.0, 0.9)})
    named = named_in(Beside(best, 0.0, confirmed), data)
    assert (named is not None and named.weights[DELAY].instead == ()) is not told


def by_direction(*free: str, **values: float) -> tuple[Data, Supported]:
    """A valve whose preload and friction have drifted, and friction by direction that does the same."""
    data = data_on(disturbed({"spring_preload": 0.27, "coulomb_friction": 0.22}, 0))
    variant = Variant("direction_dependent_friction", free)
    start = {f"{variant.effect}.{name}": value for name, value in values.items()}
    best = settled(data, NOMINAL, Estimator(data, NOMINAL).at(Explanation((), (variant,)), start))
    return data, Supported(NOMINAL, best, {variant: Weight(1000.0, 100.0, 100.0, 0.9)})


def test_two_drifts_are_told_in_the_place_of_an_effect_with_as_many_numbers():
    data, named = by_direction(
        "viscous_difference", "coulomb_difference", viscous_difference=0.0, coulomb_difference=0.04
    )
    told = told_apart(named, Weighing(data, NOMINAL, Inline()), lambda _: None)
    assert told.scored.fit.explanation == Explanation(("spring_preload", "coulomb_friction"))
    assert told.scored.fit.values["spring_preload"] == pytest.approx(0.27, rel=0.03)
    fit = named.scored.fit
    assert not confirmed_beside(fit, Weighing(data, NOMINAL, Inline()), lambda _: None)


def test_an_effect_with_fewer_numbers_is_told_with_the_drifts_that_fit_alike():
    data, named = by_direction("coulomb_difference", coulomb_difference=0.04)
    told = told_apart(named, Weighing(data, NOMINAL, Inline()), lambda _: None)
    assert told.scored is named.scored
    assert ("spring_preload", "coulomb_friction") in next(iter(told.weights.values())).instead


@pytest.mark.parametrize(
    ("variant", "values", "heard"),
    [
        (("amplitude", "frequency", "phase"), {"amplitude": 0.06, "frequency": 3.1, "phase": 0.4, "end": 1e9}, True),
        (("torque", "start", "end"), {"torque": 0.08, "start": 4.0, "end": 11.0}, False),
    ],
)
def test_a_load_that_pulsates_is_heard_and_one_that_comes_and_goes_is_not(variant, values, heard):
    """What acts between two moments may be anything that happened then."""
    load = Variant("external_load", variant)
    true = {f"external_load.{name}": value for name, value in values.items()}
    data = data_on(disturbed(true, 0))
    fit = Estimator(data, NOMINAL).at(Explanation((), (load,)), true)
    found = likelier(beginning(data), fit, Weighing(data, NOMINAL, Inline()))
    assert found.reached.fit.explanation.effects == ("external_load",)
    assert (load in found.confirmed.weights) is heard
