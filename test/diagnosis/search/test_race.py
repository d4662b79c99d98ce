"""The race of candidates, with runners whose errors are given: who falls out, who gets a whole fit."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from support.fits import made_up
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search import race as race_of
from pierburg_ros.diagnosis.search.race import ROUNDS, winners
from pierburg_ros.diagnosis.search.screening import Candidate
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
SMOOTH = tuple(
    Variant(effect, ("x",))
    for effect in (
        "sensor_lag", "viscous_friction", "supply_sag", "nonlinear_spring",
        "input_delay", "pwm_deadband", "armature_inductance",
    )
)  # fmt: skip
LAG, VISCOUS = SMOOTH[:2]
LOST = made_up(Explanation(), 10.0, NOMINAL)


class Track:
    """Stands for an estimator: the error of each fit is given; keeps what it was asked."""

    def __init__(self, ratio: Callable[[Explanation, dict[str, float], bool], float]) -> None:
        self.ratio = ratio
        self.asked: list[tuple[str, int, bool]] = []

    @property
    def between_rests(self) -> "Track":
        return self

    def fit(
        self, explanation: Explanation, start: dict[str, float], iterations: int, *, forgiving: bool = False
    ) -> Fit:
        self.asked.append((explanation.label, iterations, forgiving))
        return made_up(explanation, self.ratio(explanation, start, forgiving), NOMINAL, dict(start))


def by_effect(**ratios: float) -> Track:
    """A track on which each effect, or parameter, has its error."""
    return Track(lambda explanation, _start, _forgiving: ratios[explanation.label])


def candidate(addition: str | Variant, track: Track, base: Fit = LOST, starts: int = 1) -> Candidate:
    explanation = Explanation((addition,)) if isinstance(addition, str) else Explanation((), (addition,))
    return Candidate(explanation, addition, track, base, tuple({"number": float(n)} for n in range(starts)))  # type: ignore[arg-type]


def race(candidates: list[Candidate], known: float = np.inf, most: int | None = None) -> list[str]:
    """Labels of the winners, the best first, with `known` the error of the best explanation of that size so far."""
    best = {each.estimator: known for each in candidates}
    with ThreadPoolExecutor(2) as pool:
        return [fit.explanation.label for fit in winners(candidates, best, pool, lambda _: None, most)]


def test_the_best_come_first() -> None:
    track = by_effect(sensor_lag=2.0, viscous_friction=1.5, supply_sag=4.0)
    assert race([candidate(variant, track) for variant in SMOOTH[:3]]) == [
        "viscous_friction", "sensor_lag", "supply_sag",
    ]  # fmt: skip


def test_what_is_three_times_behind_falls_out_after_its_first_iterations() -> None:
    track = by_effect(sensor_lag=2.0, viscous_friction=6.5)
    assert race([candidate(LAG, track), candidate(VISCOUS, track)]) == ["sensor_lag"]
    assert [asked for asked in track.asked if asked[0] == "viscous_friction"] == [
        ("viscous_friction", ROUNDS // 2, False)
    ]


def test_what_is_behind_the_best_known_falls_out_too() -> None:
    track = by_effect(sensor_lag=4.0)
    assert race([candidate(LAG, track)], known=1.2) == []
    assert race([candidate(LAG, track)], known=2.0) == ["sensor_lag"]


def test_drifts_stay_however_far_behind() -> None:
    track = by_effect(sensor_lag=1.5, spring_preload=9.0)
    assert race([candidate(LAG, track), candidate("spring_preload", track)]) == ["sensor_lag", "spring_preload"]


@pytest.mark.parametrize(("leader", "stays"), [(1.2, True), (1.01, False)])
def test_what_jumps_stays_while_nothing_accounts_for_all(leader: float, stays: bool) -> None:
    track = by_effect(sensor_lag=leader, static_friction=9.0)
    assert ("static_friction" in race([candidate(LAG, track), candidate(STICTION, track)])) == stays


def test_four_get_a_whole_fit_and_whoever_is_near_the_first() -> None:
    far = dict(zip((variant.effect for variant in SMOOTH), (2.0, 3.0, 3.1, 3.2, 3.3, 3.4, 3.5), strict=True))
    near = dict(zip(far, (2.0, 2.1, 2.2, 2.3, 2.5, 2.59, 2.61), strict=True))
    for ratios, count in ((far, 4), (near, 6)):
        track = by_effect(**ratios)
        assert race([candidate(variant, track) for variant in SMOOTH]) == list(ratios)[:count]


def test_on_top_of_what_accounts_for_all_only_a_plain_gain_is_followed() -> None:
    """2000 samples at 1.02 are a chi2 of 2081: one at 1.015 gains 20, one at 1.018 only 8."""
    adequate = made_up(Explanation(), 1.02, NOMINAL)
    track = by_effect(sensor_lag=1.015, viscous_friction=1.018)
    assert race([candidate(LAG, track, adequate), candidate(VISCOUS, track, adequate)]) == ["sensor_lag"]


def test_of_several_starts_the_best_stands_for_an_explanation() -> None:
    track = Track(lambda _explanation, start, _forgiving: 3.0 - start["number"])
    with ThreadPoolExecutor(1) as pool:
        (won,) = winners([candidate(LAG, track, starts=2)], {track: np.inf}, pool, lambda _: None)  # type: ignore[dict-item]
    assert won.ratio == pytest.approx(2.0)
    assert won.values["number"] == 1.0


def test_only_so_many_enter_the_second_round_and_each_explanation_once() -> None:
    track = by_effect(sensor_lag=2.0, viscous_friction=2.2, supply_sag=2.1)
    assert race([candidate(variant, track, starts=2) for variant in SMOOTH[:3]], most=2) == ["sensor_lag", "supply_sag"]
    # Six first looks, from two starts each, and two second ones.
    assert len(track.asked) == 6 + 2


def test_where_events_jump_a_fit_that_forgives_may_lead_further() -> None:
    """The forgiving fit passes on where it has ended, and the ordinary one from there is the better."""

    def ratio(_explanation: Explanation, start: dict[str, float], forgiving: bool) -> float:
        return 1.5 if ("static_friction", ROUNDS, True) in track.asked and not forgiving else 3.0

    track = Track(ratio)
    with ThreadPoolExecutor(1) as pool:
        (won,) = winners([candidate(STICTION, track)], {track: np.inf}, pool, lambda _: None)  # type: ignore[dict-item]
    assert won.ratio == pytest.approx(1.5)
    smooth = by_effect(sensor_lag=3.0)
    race([candidate(LAG, smooth)])
    assert not any(forgiving for _, _, forgiving in smooth.asked)


@pytest.mark.parametrize(("leader", "dated"), [(2.0, True), (1.5, False), (1.02, False)])
def test_a_change_near_the_best_is_dated_anew_unless_that_accounts_for_all(monkeypatch, leader, dated) -> None:
    """A change with an error of 2.2 that dating takes to 0.99."""
    change = Explanation(changed="spring_stiffness")
    track = Track(lambda explanation, _start, _forgiving: 2.2 if explanation == change else leader)
    monkeypatch.setattr(race_of, "redated", lambda _, fit: made_up(fit.explanation, 0.99, NOMINAL))
    running = [candidate(LAG, track), Candidate(change, "spring_stiffness", track, LOST, ({},))]  # type: ignore[arg-type]
    assert race(running) == ([change.label, "sensor_lag"] if dated else ["sensor_lag", change.label])


def test_without_prospects_nobody_wins() -> None:
    assert race([]) == []
