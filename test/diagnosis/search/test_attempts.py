"""What is kept of all that was tried, and which explanation is preferred."""

from dataclasses import replace

import pytest
from support.fits import made_up, of_chi2
from support.grown import LAG, NOTHING, VISCOUS
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search import attempts
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.diagnosis.search.selection import TIED
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant

LOAD = Variant("external_load", ("torque", "start", "end"))


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
