"""Which fits are searched for other local minima: those that lead, or may only have stopped too early."""

from dataclasses import replace
from typing import Any

import pytest
from support.fits import made_up
from support.grown import FRICTION, LAG, NOTHING, ONES, PAIRS
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search import attempts
from pierburg_ros.diagnosis.search import search as module
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant


@pytest.mark.parametrize(
    ("along", "between", "refined"), [(4.0, 8.0, True), (17.0, 3.0, True), (6.0, 6.0, False), (0.99, 1.0, False)]
)
def test_a_ripple_is_refined_where_it_comes_near_along_recordings_or_between_rests(
    empty: Search, monkeypatch: pytest.MonkeyPatch, along: float, between: float, refined: bool
) -> None:
    """Between rests no slip displaces what follows, so the search for other minima begins at the values found there."""
    again, own = list[Fit](), {"sensor_lag.time_constant": 0.012}
    fits = made_up(Explanation((), (LAG,)), along, NOMINAL), made_up(Explanation((), (LAG,)), between, NOMINAL, own)
    monkeypatch.setattr(module, "ripples", lambda _: [(LAG, None)])
    monkeypatch.setattr(module, "between_rests", lambda *_: [fits])
    monkeypatch.setattr(empty, "refine_alone", again.append)
    empty._fit_ripples([empty.keep(made_up(NOTHING, 9.0, NOMINAL))])
    assert [fit.values["sensor_lag.time_constant"] for fit in again] == [0.012] * refined


@pytest.mark.parametrize(
    ("effect", "left", "refined"), [("backlash", 4.0, 1), ("backlash", 6.0, 0), ("sensor_lag", 4.0, 0)]
)
def test_what_leads_near_the_noise_is_refined_before_all_drifts_are_fitted(
    empty: Search, monkeypatch: pytest.MonkeyPatch, effect: str, left: float, refined: int
) -> None:
    """Only where events jump it may have stopped too early; what is adequate then ends the search of its size."""
    pair = FRICTION.plus(Variant(effect, ("x",)))
    monkeypatch.setattr(empty, "refine_alone", lambda fit: empty.keep(made_up(fit.explanation, 1.0, NOMINAL)))
    monkeypatch.setattr(empty, "_followed", lambda _: False)
    monkeypatch.setattr(empty, "_all_drift", lambda: False)
    single = empty.keep(made_up(FRICTION, 20.0, NOMINAL))
    empty.keep(made_up(pair, left, NOMINAL))
    assert empty._accounted_for(single) == bool(refined)


@pytest.mark.parametrize("effect", ["backlash", "sensor_lag"])
def test_what_leads_is_refined_if_its_events_jump_however_much_it_leaves(
    empty: Search, monkeypatch: pytest.MonkeyPatch, effect: str
) -> None:
    refined = list[Fit]()
    monkeypatch.setattr(empty, "refine_alone", refined.append)
    monkeypatch.setattr(empty, "_fit_ripples", lambda _: None)
    monkeypatch.setattr(empty, "_exchange_drift", lambda _: None)
    single = empty.keep(made_up(FRICTION, 74.0, NOMINAL))
    leading = empty.keep(made_up(FRICTION.plus(Variant(effect, ("x",))), 39.0, NOMINAL))
    empty._lead_tried_harder([single], 2)
    assert refined == ([leading] if effect == "backlash" else [])


def test_what_a_ripple_has_refined_is_not_refined_again(empty: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    """The fit that led before ripples were looked for may have been replaced by then."""
    again = list[Fit]()
    single = empty.keep(made_up(FRICTION, 74.0, NOMINAL))
    leading = empty.keep(made_up(FRICTION.plus(ONES[3].variants[0]), 39.0, NOMINAL))
    lower = replace(made_up(leading.explanation, 9.0, NOMINAL), refined=True)
    monkeypatch.setattr(empty, "_fit_ripples", lambda _: empty.keep(lower))
    monkeypatch.setattr(empty, "_refine", lambda _, fit: again.append(fit))
    monkeypatch.setattr(empty, "_exchange_drift", lambda _: None)
    empty._lead_tried_harder([single], 2)
    assert not again


@pytest.mark.parametrize(("other", "refined"), [(30.0, 2), (50.0, 1)])
def test_each_other_drift_gets_its_chance_beside_a_refined_effect_whose_events_jump(
    empty: Search, monkeypatch: pytest.MonkeyPatch, other: float, refined: int
) -> None:
    """What is better so is refined in turn; each drift begins at the values of the effect."""
    again, starts = list[Explanation](), dict[Explanation, Any]()
    exchanged = PAIRS[3]

    def add(explanation: Explanation, start: Any) -> Fit:
        starts[explanation] = start["spring_preload"]
        return empty.keep(made_up(explanation, other if explanation == exchanged else 90.0, NOMINAL))

    monkeypatch.setattr(empty, "_fit_ripples", lambda _: None)
    monkeypatch.setattr(empty, "refine_alone", lambda fit: again.append(fit.explanation))
    monkeypatch.setattr(empty, "add", add)
    single = empty.keep(made_up(FRICTION, 74.0, NOMINAL))
    leading = empty.keep(made_up(FRICTION.plus(ONES[3].variants[0]), 39.0, NOMINAL, {"spring_preload": 0.3}))
    empty._lead_tried_harder([single], 2)
    assert again == [leading.explanation, exchanged][:refined]
    assert len(starts) == len(empty.drifts) - 1
    assert set(starts.values()) == {0.3}


@pytest.mark.parametrize(
    ("one", "raced", "refined"),
    [("backlash", 1.0, True), ("backlash", 2.0, False), ("sensor_lag", 1.0, False)],
    ids=["accounted for its samples", "did not", "nothing jumps"],
)
def test_what_accounted_for_the_samples_it_raced_on_is_refined(
    empty: Search, monkeypatch: pytest.MonkeyPatch, one: str, raced: float, refined: bool
) -> None:
    """On a part of the recording it left so much, on all of it six noises."""
    explanation = Explanation((), (Variant(one, ("x",)),))
    base = empty.keep(made_up(NOTHING, 9.0, NOMINAL))
    candidate = Candidate(explanation, explanation.variants[0], empty.whole, base, ())
    monkeypatch.setattr(attempts, "winners", lambda *_: [made_up(explanation, raced, NOMINAL)])
    monkeypatch.setattr(empty, "add", lambda explanation, _: empty.keep(made_up(explanation, 6.0, NOMINAL)))
    given: list[Fit] = []
    monkeypatch.setattr(empty, "refine", given.extend)
    empty.race([candidate])
    assert [fit.explanation for fit in given] == ([explanation] if refined else [])


@pytest.mark.parametrize(
    ("one", "drifted", "raced", "whole", "refined"),
    [
        ("backlash", FRICTION.drifted, 3.0, 8.5, True),
        ("backlash", FRICTION.drifted, 5.0, 8.5, False),
        ("backlash", FRICTION.drifted, 3.0, 3.5, False),
        ("supply_sag", FRICTION.drifted, 3.0, 8.5, False),
        ("backlash", (), 3.0, 8.5, False),
    ],
    ids=["lost in the rest", "gained little", "still far below", "nothing jumps", "no drift"],
)
def test_what_led_a_race_by_far_and_lost_that_in_the_rest_of_the_recording_is_refined(
    empty: Search,
    monkeypatch: pytest.MonkeyPatch,
    one: str,
    drifted: tuple[str, ...],
    raced: float,
    whole: float,
    refined: bool,
) -> None:
    """The drift leaves nine noises in the race and in all: a slip at the wrong moment displaces what follows."""
    drift = Explanation(drifted)
    explanation = Explanation(drifted, (Variant(one, ("x",)),))
    base = empty.keep(made_up(drift, 9.0, NOMINAL))
    candidate = Candidate(explanation, explanation.variants[0], empty.whole, base, ())
    monkeypatch.setattr(attempts, "winners", lambda *_: [made_up(explanation, raced, NOMINAL)])
    monkeypatch.setattr(empty, "add", lambda explanation, _: empty.keep(made_up(explanation, whole, NOMINAL)))
    given: list[Fit] = []
    monkeypatch.setattr(empty, "refine_alone", given.append)
    empty.race([candidate])
    assert [fit.explanation for fit in given] == [explanation] * refined


@pytest.mark.parametrize("changed", [None, "spring_preload"])
def test_a_change_in_mid_recording_keeps_no_other_fit_from_being_refined(
    empty: Search, monkeypatch: pytest.MonkeyPatch, changed: str | None
) -> None:
    """It is held against other changes alone."""
    refined: list[Fit] = []
    monkeypatch.setattr(empty, "refine", refined.extend)
    leading = made_up(Explanation(("coulomb_friction",), ONES[3].variants, changed), 4.0, NOMINAL)
    for fit in (made_up(NOTHING, 12.0, NOMINAL), made_up(Explanation(changed="spring_preload"), 6.0, NOMINAL), leading):
        empty.keep(fit)
    empty.refine_leading(leading.explanation.size)
    assert refined == ([] if changed else [leading])


@pytest.mark.parametrize(("reached", "kept"), [(3.0, 3.0), (9.0, 6.0)])
def test_a_search_for_other_minima_replaces_no_better_fit(
    empty: Search, monkeypatch: pytest.MonkeyPatch, reached: float, kept: float
) -> None:
    """It may begin elsewhere than at the best fit known, as that of a ripple does."""
    monkeypatch.setattr("pierburg_ros.diagnosis.search.attempts.refined", lambda *_: made_up(ONES[3], reached, NOMINAL))
    empty.keep(made_up(ONES[3], 6.0, NOMINAL))
    empty.refine_alone(made_up(ONES[3], 20.0, NOMINAL))
    assert empty.fits[ONES[3]].ratio == pytest.approx(kept)
    assert empty.fits[ONES[3]].refined
