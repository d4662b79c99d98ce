"""A second look finds the values that a descent over a rough cost has missed."""

from collections.abc import Callable

import pytest
from support.recordings import NOMINAL, data_on, recording, recording_in_closed_loop

from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.refinement import FINEST, SHORTEST, _evolved, _landings, refined
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.recording import Recording

STICTION = Explanation((), (Variant("static_friction", ("breakaway_torque", "stribeck_velocity")),))


@pytest.mark.parametrize(
    ("record", "duration", "truth", "start"),
    [
        (recording, 24.0, (0.27, 0.1), (0.25, 0.12)),
        # the search between rests stops early where little was recorded
        pytest.param(recording_in_closed_loop, 20.0, (0.27, 0.12), (0.297, 0.096), marks=pytest.mark.search),
    ],
)
def test_reaches_the_noise_where_a_descent_stops_early(
    record: Callable[..., Recording], duration: float, truth: tuple[float, float], start: tuple[float, float]
) -> None:
    estimator = Estimator(data_on(record(dict(zip(STICTION.names, truth, strict=True)), duration=duration)), NOMINAL)
    stopped = estimator.fit(STICTION, dict(zip(STICTION.names, start, strict=True)))
    found = refined(estimator, stopped)
    assert stopped.ratio > 2.0
    assert found.ratio < 1.03
    assert found.values["static_friction.breakaway_torque"] == pytest.approx(0.27, rel=0.03)


@pytest.mark.search
def test_leaps_in_a_short_part_of_a_minute_in_closed_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaps need most of the simulations, and few slips can go wrong there."""
    truth = {"static_friction.breakaway_torque": 0.22, "static_friction.stribeck_velocity": 0.05}
    estimator = Estimator(data_on(recording_in_closed_loop(truth, duration=60.0)), NOMINAL)
    start = {"static_friction.breakaway_torque": 0.242, "static_friction.stribeck_velocity": 0.04}
    stopped = estimator.fit(STICTION, start)
    leapt = []

    def landings(where: Estimator, fit: Fit) -> list[dict[str, float]]:
        leapt.append(where.data.duration)
        return _landings(where, fit)

    monkeypatch.setattr("pierburg_ros.estimation.refinement._landings", landings)
    found = refined(estimator, stopped)
    assert stopped.ratio > 1.2
    assert found.ratio < 1.03
    assert found.solution.residual.size == stopped.solution.residual.size
    assert len(leapt) == 1
    assert leapt[0] <= 15.0


def test_never_makes_a_fit_worse() -> None:
    """Where a descent has ended in the minimum of a smooth cost, nothing is left to find."""
    estimator = Estimator(data_on(recording({"spring_preload": 0.3}, duration=6.0)), NOMINAL)
    fit = estimator.fit(Explanation(("spring_preload", "coulomb_friction")))
    again = refined(estimator, fit)
    assert again.refined and not fit.refined
    assert again.chi2 <= fit.chi2
    assert again.values["spring_preload"] == pytest.approx(0.3, rel=0.002)


def test_a_population_goes_on_from_where_slopes_say_nothing() -> None:
    """Whatever the differences of the last descent: over fine ones a single slip makes a slope that is none."""
    truth = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
    estimator = Estimator(data_on(recording(truth)), NOMINAL)
    start = {"static_friction.breakaway_torque": 0.265, "static_friction.stribeck_velocity": 0.08}
    stopped = estimator.fit(STICTION, start, steps=FINEST * estimator.coordinates(STICTION).steps)
    found = _evolved(estimator, stopped)
    assert stopped.ratio > 2.0
    assert found.ratio < 1.03
    assert found.values == _evolved(estimator, estimator.restated(stopped)).values


def test_the_part_grows_unless_an_effect_takes_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Heat says nothing in the first seconds, and its numbers would wander off there."""
    heating = Explanation((), (Variant("thermal_resistance", ("thermal_resistance", "heat_capacity")),))
    estimator = Estimator(data_on(recording({"spring_preload": 0.3}, duration=40.0)), NOMINAL)
    shortest = SHORTEST * NOMINAL.scales.time
    for explanation, parts in ((STICTION, [shortest, 2.0 * shortest, 40.0]), (heating, [40.0])):
        searched = []

        def remember(where: Estimator, fit: Fit, leaping: bool, searched: list[tuple[float, bool]] = searched) -> Fit:
            searched.append((where.data.duration, leaping))
            return fit

        monkeypatch.setattr("pierburg_ros.estimation.refinement._searched", remember)
        refined(estimator, estimator.at(explanation))
        assert [leaping for _, leaping in searched] == [True] + [False] * (len(parts) - 1)
        assert [duration for duration, _ in searched] == pytest.approx(parts, abs=0.01)
