"""The way between values and the coordinates of a search."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, PIERBURG, data_on, recording

from pierburg_ros.effects.effect import Start
from pierburg_ros.inference.coordinates import Coordinates, in_order, without_effects
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant
from pierburg_ros.inference.shortlist import Span, forms
from pierburg_ros.plant import Model

STICTION = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
STARTS: list[tuple[Variant, list[Start]]] = forms(
    data_on(recording({}, duration=5.0)), NOMINAL, Span(duration=5.0 / PIERBURG.scales.time, low=0.0, high=1.0)
)
"""Every way in which an effect may act in the valve, and where a search for it starts."""
FRICTION = "coulomb_friction"
BREAKAWAY = "static_friction.breakaway_torque"
VISCOUS = "viscous_friction.coefficient"
DIFFERENCE = "direction_dependent_friction.viscous_difference"


@pytest.mark.parametrize(
    ("variant", "starts"), [pytest.param(*each, id=f"{each[0].effect}-{each[0].free[0]}") for each in STARTS]
)
def test_values_survive_the_way_through_coordinates(variant: Variant, starts: list[Start]) -> None:
    names = tuple(f"{variant.effect}.{name}" for name in variant.free)
    coordinates = Coordinates((FRICTION, *names), NOMINAL, 60.0)
    for start in starts:
        values = {f"{variant.effect}.{name}": start[name] for name in variant.free}
        values[FRICTION] = 0.18
        if BREAKAWAY in values:
            values[BREAKAWAY] += 0.18
        if values.get(DIFFERENCE, 0.0) < 0.0:
            values[DIFFERENCE] = 0.0  # without damping in both directions there is none to take away
        assert coordinates.values(coordinates.point(values)) == pytest.approx(values)


def test_a_positive_base_parameter_is_searched_by_its_ratio_to_the_nominal_one() -> None:
    coordinates = Coordinates((FRICTION,), NOMINAL, 60.0)
    assert coordinates.point({FRICTION: 0.2007}) == pytest.approx(0.0, abs=1e-12)
    assert coordinates.point({FRICTION: 0.2007 * np.e / 2.0}) == pytest.approx(1.0 - np.log(2.0))


def test_a_breakaway_torque_never_falls_below_the_sliding_friction() -> None:
    coordinates = Coordinates((FRICTION, *Explanation((), (STICTION,)).names), NOMINAL, 60.0)
    lower, upper = coordinates.bounds
    for point in (lower, np.array([upper[0], *lower[1:]])):
        values = coordinates.values(point)
        assert values[BREAKAWAY] >= values[FRICTION]


def test_a_pair_out_of_order_is_put_in_order_and_others_stay() -> None:
    values = {FRICTION: 0.3, BREAKAWAY: 0.25, "spring_preload": 0.2}
    assert in_order(values, NOMINAL) == {**values, BREAKAWAY: 0.3}
    absent = {FRICTION: 0.3, BREAKAWAY: 0.0}
    assert in_order(absent, NOMINAL) == absent


def test_what_is_added_to_damping_takes_away_no_more_than_there_is() -> None:
    assert in_order({VISCOUS: 0.03, DIFFERENCE: -0.05}, NOMINAL) == {VISCOUS: 0.03, DIFFERENCE: -0.03}
    possible = {VISCOUS: 0.03, DIFFERENCE: -0.02}
    assert in_order(possible, NOMINAL) == possible
    coordinates = Coordinates((VISCOUS, DIFFERENCE), NOMINAL, 60.0)
    lower, upper = coordinates.bounds
    for point in (lower, np.array([upper[0], lower[1]]), np.array([0.01, lower[1]])):
        values = coordinates.values(point)
        assert values[DIFFERENCE] >= -values[VISCOUS]


def test_without_damping_nothing_is_left_that_was_taken_away_from_it() -> None:
    model = NOMINAL.with_values({VISCOUS: 0.03, DIFFERENCE: -0.02, "presliding.stiffness": 20.0})
    left = without_effects(model, ["viscous_friction"])
    assert left.active_effects == ("presliding",)


def test_a_change_has_a_value_before_one_after_and_a_time() -> None:
    changed = "armature_resistance"
    coordinates = Coordinates(Explanation(changed=changed).names, NOMINAL, 60.0)
    values = {changed: 4.2, changed + AFTER: 5.0, changed + WHEN: 20.0}
    assert coordinates.values(coordinates.point(values)) == pytest.approx(values)
    assert np.all(coordinates.steps > 0)


def test_a_change_of_which_nothing_is_known_is_none_half_way() -> None:
    changed = "armature_resistance"
    coordinates = Coordinates(Explanation(changed=changed).names, NOMINAL, 60.0)
    values = {changed: 4.2, changed + AFTER: 4.2, changed + WHEN: 30.0}
    assert coordinates.values(coordinates.point({changed: 4.2})) == pytest.approx(values)


def test_values_out_of_reach_are_brought_within_bounds() -> None:
    """A base parameter is searched within a factor of six of its nominal value, either way."""
    coordinates = Coordinates((FRICTION,), NOMINAL, 60.0)
    for value, nearest in ((1e-6, 0.2007 / 6.0), (100.0, 0.2007 * 6.0), (0.25, 0.25)):
        assert coordinates.within({FRICTION: value})[FRICTION] == pytest.approx(nearest)


@pytest.mark.parametrize("coefficient", [0.003, 168.0])
def test_what_an_actuator_always_has_is_searched_around_its_own_size(coefficient: float) -> None:
    name = "viscous_friction.coefficient"
    effects = {"viscous_friction": {"coefficient": coefficient}}
    nominal = Model.nominal(replace(PIERBURG, effects=effects))
    coordinates = Coordinates((name,), nominal, 60.0)
    for value in (0.5 * coefficient, coefficient, 2.0 * coefficient):
        assert coordinates.within({name: value})[name] == pytest.approx(value)
