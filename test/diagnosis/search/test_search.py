"""How a search grows explanations: it finds pairs, keeps to its beam, and ends when its budget is spent."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.fits import made_up, of_chi2
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search import attempts
from pierburg_ros.diagnosis.search import search as module
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.diagnosis.search.scored import Scored
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.diagnosis.search.selection import TIED
from pierburg_ros.diagnosis.search.supported import Beside
from pierburg_ros.diagnosis.search.weighing import Supported
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.estimation.explanation import Explanation, Variant

LAG = Variant("sensor_lag", ("time_constant",))
VISCOUS = Variant("viscous_friction", ("coefficient",))
LOAD = Variant("external_load", ("torque", "start", "end"))
NOTHING = Explanation()


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with ThreadPoolExecutor(2) as threads:
        yield threads


@pytest.fixture(scope="module")
def short() -> Data:
    return data_on(recording({}, duration=5.0))


@pytest.fixture
def empty(short: Data, pool: Executor) -> Search:
    """A search that has fitted nothing yet."""
    return Search(short, NOMINAL, pool)


@pytest.mark.search
def test_a_pair_that_accounts_for_all_is_found_before_others_are_grown(pool: Executor) -> None:
    data = data_on(recording({"sensor_lag.time_constant": 0.012, "spring_preload": 0.32}))
    found = Search(data, NOMINAL, pool)
    assert found.run().explanation == Explanation(("spring_preload",), (LAG,))
    assert found.expanded == {NOTHING}
    assert len(found.of_size(2)) <= Beam().ahead // 3


@pytest.mark.search
def test_a_spent_budget_ends_the_search_and_is_told() -> None:
    """The first round alone looks at 60 candidates or so, and finds one quantity of three."""
    true = {"sensor_lag.time_constant": 0.012, "viscous_friction.coefficient": 0.03, "spring_preload": 0.32}
    data = data_on(recording(true, duration=8.0))
    found = search(data, NOMINAL, beam=Beam(budget=10))
    assert found.exhausted
    assert found.chosen.explanation.size <= 2
    assert max(explanation.size for explanation in found.fits) <= 2


@pytest.mark.search
def test_explanations_grow_no_deeper_than_the_beam() -> None:
    true = {"sensor_lag.time_constant": 0.012, "spring_preload": 0.32}
    found = search(data_on(recording(true, duration=8.0)), NOMINAL, beam=Beam(depth=1))
    assert not found.exhausted
    assert found.chosen.explanation.size == 1
    assert found.chosen.ratio > 1.1


GUESSES = {"armature_resistance": 5.2, "spring_preload": 0.3, "coulomb_friction": 0.16, "spring_stiffness": 0.11}


@pytest.mark.search
@pytest.mark.parametrize("effects", [{}, {"sensor_lag.time_constant": 0.012}])
def test_a_description_off_in_four_numbers_hides_no_effect_and_stands_for_none(
    pool: Executor, effects: dict[str, float]
) -> None:
    found = Search(data_on(recording({**GUESSES, **effects})), NOMINAL, pool).run()
    assert adequate(found)
    assert found.explanation.size <= 4 + len(effects)
    assert found.explanation.variants == ((LAG,) if effects else ())
    assert all(found.values[name] == pytest.approx(value, rel=0.02) for name, value in effects.items())


@pytest.mark.search
def test_a_search_that_is_over_too_soon_still_tells_that_all_drift() -> None:
    found = search(data_on(recording(GUESSES)), NOMINAL, beam=Beam(budget=10))
    assert found.exhausted
    assert adequate(found.chosen) and not found.chosen.explanation.variants
    assert found.chosen.explanation == found.recalibrated.explanation


@pytest.mark.search
def test_one_effect_goes_before_two_drifts_that_do_the_same(pool: Executor) -> None:
    """Viscous friction is a drift of resistance and supply voltage."""
    data = data_on(recording({"viscous_friction.coefficient": 0.03, "spring_preload": 0.32}))
    found = Search(data, NOMINAL, pool)
    assert found.run().explanation == Explanation(("spring_preload",), (VISCOUS,))


class Grown(Search):
    """A search that fits nothing: it keeps from which explanations it was asked to grow."""

    def __init__(self, data: Data, pool: Executor, ratios: dict[Explanation, float], beam: Beam) -> None:
        super().__init__(data, NOMINAL, pool, beam=beam)
        self.ratios = ratios
        self.seeds: list[Explanation] = []
        self.before_ripples: dict[int, list[Explanation]] = {}

    def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
        return self.keep(made_up(explanation, self.ratios.get(explanation, 9.0), NOMINAL))

    def expand(self, seed: Fit) -> list[Fit]:
        if seed.explanation in self.expanded:
            return []
        self.expanded.add(seed.explanation)
        self.seeds.append(seed.explanation)
        self.tried += 1
        larger = (e for e in self.ratios if e.size == seed.explanation.size + 1)
        return [self.add(explanation) for explanation in larger]

    def refine(self, fits: object) -> None:
        pass

    def refine_alone(self, fit: object) -> None:
        pass

    def fit_most_promising(self, seeds: object) -> None:
        pass

    def _fit_ripples(self, seeds: Sequence[Fit]) -> None:
        self.before_ripples.setdefault(seeds[0].explanation.size + 1, [*self.seeds])

    def _exchange_drift(self, fit: Fit) -> None:
        pass

    def _all_drift(self) -> bool:
        return False

    def _likeliest_accounts_for_all(self) -> bool:
        self.resigned = self.beam.resigns
        return False


ONES = [
    Explanation((), (Variant(effect, ("x",)),)) for effect in ("sensor_lag", "supply_sag", "pwm_deadband", "backlash")
]
PAIRS = [Explanation(("spring_preload",), one.variants) for one in ONES]
FRICTION = Explanation(("coulomb_friction",))
RATIOS = {NOTHING: 9.0, **dict(zip(ONES, (6.0, 6.1, 6.2, 6.3), strict=True)), PAIRS[0]: 2.0}


@pytest.mark.parametrize("width", [1, 2, 3])
def test_as_many_explanations_of_a_size_are_grown_as_the_beam_is_wide(short: Data, pool: Executor, width: int) -> None:
    """Of four effects alone the best are grown; single drifts, of which there are none here, would be besides."""
    found = Grown(short, pool, RATIOS, Beam(width=width, depth=2))
    assert found.run().explanation == PAIRS[0]
    assert [seed for seed in found.seeds if seed.size == 1] == ONES[:width]


def test_single_drifts_are_all_grown_and_first(short: Data, pool: Executor) -> None:
    drifts = [Explanation((name,)) for name in ("spring_preload", "coulomb_friction", "armature_resistance")]
    ratios = RATIOS | dict(zip(drifts, (7.0, 7.1, 7.2), strict=True))
    found = Grown(short, pool, ratios, Beam(width=1, depth=2))
    found.run()
    assert [seed for seed in found.seeds if seed.size == 1] == [*drifts, ONES[0]]


@pytest.mark.parametrize(
    ("place", "left", "refined", "second"),
    [(0, 14.0, False, 0), (0, 16.0, False, None), (0, 4.0, False, 0), (3, 14.0, True, 3), (3, 14.0, False, None)],
)
def test_what_leads_by_far_is_grown_before_others_of_its_size(
    short: Data, pool: Executor, place: int, left: float, refined: bool, second: int | None
) -> None:
    """By less it waits, and so it does until it is refined if events jump: it may only have stopped too early."""
    pair = PAIRS[place]
    triple = pair.plus(ONES[1].variants[0])

    class Leading(Grown):
        def fit_most_promising(self, seeds: object) -> None:
            self.keep(replace(made_up(pair, left, NOMINAL), refined=refined))

    found = Leading(short, pool, {NOTHING: 40.0, ONES[0]: 30.0, ONES[1]: 31.0, pair: left, triple: 0.99}, Beam())
    assert found.run().explanation == triple
    assert found.seeds[:2] == [NOTHING, ONES[0] if second is None else PAIRS[second]]
    assert (3 in found.before_ripples) == (second is not None), "ripples are looked for on top of it"


def test_ripples_wait_for_promising_pairs_and_come_before_drifts_are_grown(short: Data, pool: Executor) -> None:
    """Beside a drift they are found as well as alone."""

    class Leading(Grown):
        def fit_most_promising(self, seeds: object) -> None:
            self.add(PAIRS[0])

    found = Leading(short, pool, {NOTHING: 9.0, ONES[0]: 6.0, FRICTION: 6.1, PAIRS[0]: 4.0}, Beam(depth=2))
    found.run()
    assert found.before_ripples == {2: [NOTHING]}
    assert FRICTION in found.seeds


def test_ripples_are_looked_for_alone_where_no_pair_will_be(short: Data, pool: Executor) -> None:
    found = Grown(short, pool, {NOTHING: 9.0, ONES[0]: 6.0}, Beam(depth=1))
    found.run()
    assert found.before_ripples == {1: [NOTHING]}


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


@pytest.mark.parametrize(("effect", "expected"), [(6.0, [1, 2, 1]), (8.0, [2, 1])])
def test_an_effect_that_has_adapted_to_a_ripple_does_not_hide_it(
    empty: Search, monkeypatch: pytest.MonkeyPatch, effect: float, expected: list[int]
) -> None:
    """If an effect leads, the drifts are looked at without it first; the nominal model comes last in any case."""
    grown = list[int]()

    def between_rests(whole: Any, variant: Variant, ripple: Any, bases: dict[Explanation, Fit], pool: Any) -> list[Any]:
        grown.append(len(bases))
        return []

    monkeypatch.setattr(module, "ripples", lambda _: [(Variant("cogging_torque", ("amplitude",)), None)])
    monkeypatch.setattr(module, "between_rests", between_rests)
    empty.keep(made_up(NOTHING, 9.0, NOMINAL))
    empty._fit_ripples([made_up(FRICTION, 7.0, NOMINAL), made_up(ONES[0], effect, NOMINAL)])
    assert grown == expected


def test_what_does_not_account_for_all_ends_no_growth_of_what_is_smaller(short: Data, pool: Executor) -> None:
    """Three quantities that are likeliest beside a remainder may be known before any pair has been grown."""
    three, right = PAIRS[0].plus(ONES[3].variants[0]), PAIRS[1].plus(ONES[3].variants[0])

    class Known(Grown):
        def _likeliest_accounts_for_all(self) -> bool:
            self.add(three)
            return False

        def expand(self, seed: Fit) -> list[Fit]:
            return [self.add(right)] if seed.explanation == PAIRS[1] else super().expand(seed)

    ratios = {NOTHING: 40.0, ONES[0]: 30.0, ONES[1]: 31.0, PAIRS[1]: 20.0, three: 8.0}
    found = Known(short, pool, ratios, Beam())
    found.ratios[right] = 0.99
    assert found.run().explanation == right


def test_a_budget_ends_the_growth_within_a_size(short: Data, pool: Executor) -> None:
    found = Grown(short, pool, RATIOS, Beam(budget=2))
    found.run()
    assert found.exhausted
    assert found.seeds == [NOTHING, ONES[0]]


def test_a_search_that_resigns_grows_nothing_in_turn(short: Data, pool: Executor) -> None:
    found = Grown(short, pool, RATIOS, Beam(resigns=True))
    found.run()
    assert found.seeds == [NOTHING]


STICKS, LAGS = (Explanation((), (Variant(one, ("x",)),)) for one in ("static_friction", "sensor_lag"))


@pytest.mark.parametrize(
    ("nearest", "refined", "left", "beside", "resigned"),
    [
        (STICKS, False, 5000.0, 30.0, True),
        (STICKS, False, 100.0, 30.0, False),
        (STICKS, False, 5000.0, 3.0, False),
        (STICKS, True, 5000.0, 3.0, False),
        (STICKS, True, 5000.0, 1.0, False),
        (LAGS, False, 100.0, 30.0, True),
        (LAGS, False, 100.0, 3.0, True),
        (LAGS, False, 100.0, 1.0, False),
    ],
)
def test_it_resigns_where_much_is_left_that_nothing_accounts_for_or_the_nearest_has_no_other_minimum(
    empty: Search,
    monkeypatch: pytest.MonkeyPatch,
    nearest: Explanation,
    refined: bool,
    left: float,
    beside: float,
    resigned: bool,
) -> None:
    """Of 10,000 in -2 log likelihood so much is left; what was reached, fitted by itself, leaves `beside` noises."""
    reached = made_up(nearest, 1.0, NOMINAL)
    scored = Scored(reached, Discrepancy(5.0, 1.0, 1.0), left + reached.solution.residual.size)
    monkeypatch.setattr(module, "supported", lambda *_: Beside(scored, 10_000.0, Supported(NOMINAL, scored, {})))
    fitted = replace(made_up(nearest, beside, NOMINAL), refined=refined)
    monkeypatch.setattr(empty, "add", lambda *_: empty.keep(fitted))
    monkeypatch.setattr(empty, "refine", lambda _: None)
    empty.beam = Beam(resigns=True)
    assert empty._likeliest_accounts_for_all() == (beside == 1.0)
    assert empty.resigned == resigned
    assert not empty._likeliest_accounts_for_all(), "asked once"


def test_a_search_that_resigns_ends_where_drifts_have_been_grown(short: Data, pool: Executor) -> None:
    """Unless one of them accounts for all, neither effects are grown nor pairs."""

    class Rough(Grown):
        def _likeliest_accounts_for_all(self) -> bool:
            return False

    def grown(ratios: dict[Explanation, float], resigns: bool) -> Rough:
        found = Rough(short, pool, ratios, Beam(resigns=resigns))
        found.run()
        return found

    ratios = {NOTHING: 9.0, FRICTION: 7.0, ONES[0]: 6.0, PAIRS[0]: 2.0}
    assert grown(ratios, resigns=True).seeds == [NOTHING, FRICTION]
    assert grown(ratios, resigns=False).seeds[:3] == [NOTHING, FRICTION, ONES[0]]
    found = grown({**ratios, PAIRS[0]: 0.99}, resigns=True)
    assert found.preferred().explanation == PAIRS[0]
    assert not found.resigned


@pytest.mark.parametrize("together", [True, False])
def test_one_smooth_effect_that_needs_more_than_all_drifts_is_not_tried_beside_fewer(
    empty: Search, monkeypatch: pytest.MonkeyPatch, together: bool
) -> None:
    """Two effects are, events that jump, and a change in mid-recording."""
    two = Explanation(("spring_preload",), (*LAGS.variants, Variant("supply_sag", ("x",))))
    change = Explanation((), LAGS.variants, "spring_preload")
    explanations = [LAGS, PAIRS[0], STICKS, two, change, FRICTION]
    base, raced = empty.keep(made_up(NOTHING, 9.0, NOMINAL)), list[Explanation]()
    candidates = [Candidate(each, LAG, empty.whole, base, ()) for each in explanations]
    monkeypatch.setattr(empty, "screened", lambda _: candidates)
    monkeypatch.setattr(empty, "race", lambda given: raced.extend(each.explanation for each in given))
    monkeypatch.setattr(module, "drift_together", lambda _: together)
    assert empty._all_drift() == together
    empty.expand(base)
    assert raced == (explanations if together else [STICKS, two, change])


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


def test_to_a_fit_just_above_the_noise_nothing_is_added(short: Data, pool: Executor) -> None:
    """What is left is noise, though neighbours are correlated a little: it accounts for all."""

    class Smeared(Grown):
        def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
            fit = made_up(explanation, self.ratios.get(explanation, 9.0), NOMINAL)
            residual = fit.solution.residual + 0.1 * np.roll(fit.solution.residual, 1)
            return self.keep(replace(fit, solution=replace(fit.solution, residual=residual)))

    found = Smeared(short, pool, {NOTHING: 9.0, ONES[0]: 1.04, PAIRS[0]: 0.98}, Beam(depth=2))
    assert found.run().explanation == ONES[0]
    assert found.seeds == [NOTHING]


def test_a_drift_gets_its_chance_in_the_place_of_one_of_two_effects(short: Data, pool: Executor) -> None:
    """From where the two have ended: an effect of which little is seen stands for a drift that stopped before that."""
    two = Explanation((), tuple(sorted((*ONES[0].variants, *ONES[1].variants), key=lambda each: each.effect)))
    with_drift = Explanation(("coulomb_friction",), two.variants[:1])

    class Stopped(Grown):
        def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
            late = explanation == with_drift and two not in self.fits
            return self.keep(made_up(explanation, 5.0 if late else self.ratios.get(explanation, 9.0), NOMINAL))

    found = Stopped(short, pool, {NOTHING: 9.0, ONES[0]: 6.0, with_drift: 1.0, two: 1.005}, Beam(depth=2))
    assert found.run().explanation == with_drift


THREE = Explanation((), tuple(variant for one in (ONES[3], ONES[2], ONES[0]) for variant in one.variants))
"""Play, where events jump, a dead band and a lag."""
SWAPPED = Explanation(("spring_preload",), THREE.variants[:2])


@pytest.mark.parametrize("ways", [{THREE: PAIRS[3]}, {THREE: SWAPPED, SWAPPED: PAIRS[3]}], ids=["at once", "in turn"])
def test_a_drift_and_an_effect_get_their_chance_from_the_values_of_three(
    short: Data, pool: Executor, ways: dict[Explanation, Explanation]
) -> None:
    """Each explanation comes to the noise from the end of another alone, told by a value; three effects have."""
    ends = {explanation: 0.2 + 0.01 * place for place, explanation in enumerate([*ways, PAIRS[3]], 1)}
    starts = {to: ends[larger] for larger, to in ways.items()}

    class Stopped(Grown):
        def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
            led = start is not None and starts.get(explanation) == start["coulomb_friction"]
            end = {"coulomb_friction": ends[explanation]} if led else {}
            return self.keep(made_up(explanation, 1.0 if led else 9.0, NOMINAL, end))

    found = Stopped(short, pool, {}, Beam())
    found.add(NOTHING)
    found.keep(made_up(THREE, 1.0, NOMINAL, {"coulomb_friction": ends[THREE]}))
    assert pruned(found).explanation == PAIRS[3]


def test_what_accounts_for_all_is_not_grown(short: Data, pool: Executor) -> None:
    found = Grown(short, pool, {NOTHING: 9.0, ONES[0]: 0.99}, Beam())
    assert found.run().explanation == ONES[0]
    assert found.seeds == [NOTHING]


def test_the_better_fit_of_an_explanation_is_kept(empty: Search) -> None:
    worse, better = (made_up(NOTHING, ratio, NOMINAL) for ratio in (1.5, 1.2))
    for fit in (worse, better, worse):
        empty.keep(fit)
    assert empty.fits == {NOTHING: better}
    assert empty.keep(worse) is better


def test_of_each_size_the_best_comes_first(empty: Search) -> None:
    fits = [
        made_up(Explanation((name,)), ratio, NOMINAL)
        for name, ratio in (("spring_preload", 1.4), ("coulomb_friction", 1.2))
    ]
    for fit in fits:
        empty.keep(fit)
    assert empty.of_size(1) == fits[::-1]
    assert empty.best_of_size(1) is fits[1]
    assert empty.best_of_size(2) is None


@pytest.mark.parametrize(("drifts", "left", "counts"), [(4.0, 3.5, False), (4.0, 2.5, True), (1.3, 0.99, True)])
def test_a_change_in_mid_recording_counts_where_it_leaves_far_less_or_accounts_for_all(
    empty: Search, drifts: float, left: float, counts: bool
) -> None:
    drift = made_up(Explanation(("spring_preload",)), drifts, NOMINAL)
    change = made_up(Explanation(changed="coulomb_friction"), left, NOMINAL)
    for fit in (drift, change):
        empty.keep(fit)
    assert empty.of_size(1) == ([change, drift] if counts else [drift])


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


@pytest.mark.parametrize(("above", "expected"), [(0.5 * TIED, ("spring_preload",)), (2.0 * TIED, ())])
def test_of_explanations_that_fit_alike_a_drift_goes_before_an_effect(
    empty: Search, above: float, expected: tuple[str, ...]
) -> None:
    empty.keep(made_up(NOTHING, 2.0, NOMINAL))
    empty.keep(of_chi2(Explanation((), (LAG,)), 0.0, NOMINAL))
    empty.keep(of_chi2(Explanation(("spring_preload",)), above, NOMINAL))
    assert empty.preferred().explanation.drifted == expected


def test_of_effects_that_fit_alike_that_with_fewer_numbers_is_preferred(empty: Search) -> None:
    empty.keep(made_up(NOTHING, 2.0, NOMINAL))
    empty.keep(of_chi2(Explanation((), (LOAD,)), 0.0, NOMINAL))
    empty.keep(of_chi2(Explanation((), (VISCOUS,)), 0.5 * TIED, NOMINAL))
    assert empty.preferred().explanation.effects == ("viscous_friction",)


def test_a_drift_goes_before_a_change_in_the_middle(empty: Search) -> None:
    empty.keep(made_up(NOTHING, 2.0, NOMINAL))
    empty.keep(of_chi2(Explanation(changed="spring_preload"), 0.0, NOMINAL))
    empty.keep(of_chi2(Explanation(("spring_preload",)), 0.5 * TIED, NOMINAL))
    assert empty.preferred().explanation.drifted == ("spring_preload",)


def test_a_seed_is_expanded_once(empty: Search, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Explanation] = []

    def screened(fit: Fit, *_: object) -> list[object]:
        asked.append(fit.explanation)
        return []

    monkeypatch.setattr(attempts, "screened", screened)
    seed = made_up(NOTHING, 2.0, NOMINAL)
    assert empty.expand(seed) == empty.expand(replace(seed)) == []
    assert asked == [NOTHING]
