"""How a search grows explanations: it finds pairs, keeps to its beam, and ends when its budget is spent."""

from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.fits import made_up
from support.grown import FRICTION, LAG, NOTHING, ONES, PAIRS, VISCOUS, Grown
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search import search as module
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.diagnosis.search.scored import Scored
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.diagnosis.search.supported import Beside
from pierburg_ros.diagnosis.search.weighing import Supported
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.inference.explanation import Explanation, Variant

LAGS, STICKS = ONES[0], Explanation((), (Variant("static_friction", ("x",)),))


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


def test_what_accounts_for_all_is_not_grown(short: Data, pool: Executor) -> None:
    found = Grown(short, pool, {NOTHING: 9.0, ONES[0]: 0.99}, Beam())
    assert found.run().explanation == ONES[0]
    assert found.seeds == [NOTHING]
