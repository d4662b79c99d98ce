"""What trials draw: repeatable, within the catalogue's ranges, and never with two right answers."""

import pytest

from pierburg_ros.effects import EFFECT
from pierburg_ros.proof.concealment import KINDS, PUBLISHED, WITHOUT_EFFECT, draw, schedule
from pierburg_ros.proof.formulation.values import CATALOGUE, NOMINAL, OUTSIDE
from pierburg_ros.proof.strengths import TIED
from pierburg_ros.proof.trial import concealed_values, truth, unit


def test_the_second_list_of_effects_is_the_catalogue():
    assert {name: tuple(fields) for name, fields in CATALOGUE.items()} == {
        name: effect.names for name, effect in EFFECT.items()
    }


def test_units_are_those_of_the_catalogue():
    for name, effect in EFFECT.items():
        for parameter in effect.parameters:
            assert unit(name, parameter.name) == parameter.unit, f"{name}.{parameter.name}"


@pytest.mark.parametrize("kind", KINDS)
def test_a_trial_is_the_same_each_time_and_differs_from_the_next(kind):
    assert draw(kind, 1, 7) == draw(kind, 1, 7)
    assert draw(kind, 1, 7).seed != draw(kind, 3, 7).seed
    assert draw(kind, 1, 7).seed != draw(kind, 1, 8).seed


@pytest.mark.parametrize("kind", CATALOGUE)
def test_strengths_lie_in_the_catalogues_ranges(kind):
    for number in range(12):
        for name, value in draw(kind, number, 3).effects.items():
            effect, _, parameter = name.partition(".")
            declared = EFFECT[effect].parameter(parameter)
            assert declared.minimum <= value <= declared.maximum


@pytest.mark.parametrize("kind", TIED)
def test_no_drift_is_drawn_with_which_the_effect_is_two_drifts(kind):
    drifted = {name for number in range(40) for name in draw(kind, number, 3).drifted}
    assert drifted and not drifted & set(TIED[kind])


def test_odd_trials_run_in_closed_loop_and_are_mostly_drifted_too():
    trials = [draw("backlash", number, 3) for number in range(40)]
    assert [trial.closed_loop for trial in trials] == [number % 2 == 1 for number in range(40)]
    assert not any(trial.drifted for trial in trials[::2])
    assert sum(bool(trial.drifted) for trial in trials[1::2]) >= 10


def test_every_physics_outside_the_catalogue_has_its_turn():
    found = {name for number in range(24) for name in draw("outside", number, 3).effect_ids}
    assert found == set(OUTSIDE)


@pytest.mark.parametrize(
    ("kind", "verdict"),
    [("consistent", "consistent"), ("drift", "parameter_drift"), ("two", "missing_physics")],
)
def test_the_label_says_what_is_right(kind, verdict):
    trial = draw(kind, 1, 3)
    label = truth(trial)
    assert label["verdict"] == verdict
    assert len(label["effects"]) == (2 if kind == "two" else 0)
    effects, drifted = concealed_values(label)
    assert {**NOMINAL, **drifted, **effects} == trial.values


def test_a_label_outside_the_catalogue_keeps_its_values():
    trial = draw("outside", 1, 3)
    label = truth(trial)
    assert label["verdict"] == "unexplained" and not label["effects"]
    assert label["not_in_catalogue"] in OUTSIDE
    assert concealed_values(label)[0] == dict(trial.effects)


def test_a_remainder_is_there_with_an_effect_and_without():
    beside, alone = draw("beside", 4, 3), draw("remainder", 1, 3)
    assert len(truth(beside)["effects"]) == 1 and not truth(alone)["effects"]
    for trial in (beside, alone):
        assert trial.verdict == "unexplained"
        assert trial.remainder["relaxation.stiffness"] == pytest.approx(0.05 * NOMINAL["spring_stiffness"])
        assert trial.bare.values.items() >= trial.remainder.items()
        effects, others = concealed_values(truth(trial))
        assert {**NOMINAL, **others, **effects} == trial.values


def test_a_change_starts_from_the_nominal_value():
    trial = draw("change", 0, 3)
    assert trial.change is not None and trial.verdict == "parameter_drift"
    assert trial.values[trial.change.parameter] == trial.change.before == NOMINAL[trial.change.parameter]
    assert trial.change.after != trial.change.before


def test_a_run_cut_short_has_some_of_each_kind():
    counts = {"backlash": 4, "drift": 8, "consistent": 4}
    assert {kind for kind, _ in schedule(counts)[:4]} == set(counts)
    assert len(schedule(counts)) == len(set(schedule(counts))) == 16


def test_the_published_run_is_as_large_as_promised():
    assert all(PUBLISHED[effect] >= 20 for effect in CATALOGUE)
    assert sum(PUBLISHED[kind] for kind in WITHOUT_EFFECT) >= 100


def test_four_numbers_of_a_guessed_description_are_off():
    alone, beside = draw("guesses", 2, 3), draw("beside_guesses", 2, 3)
    assert len(alone.drifted) == len(beside.drifted) == 4
    assert alone.verdict == "parameter_drift" and not alone.effects
    assert beside.verdict == "missing_physics" and len(beside.effect_ids) == 1
    for trial in (alone, beside):
        assert all(trial.values[name] == value != NOMINAL[name] for name, value in trial.drifted.items())
