"""The choice between explanations, on a linear model whose least squares are known in closed form."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, recording

from pierburg_ros.inference.choice import Parabola, Score, predictor, sure, ties
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import Fitter, ladder

PARAMETERS = ("armature_resistance", "torque_constant", "spring_preload")


@pytest.fixture(scope="module")
def fitter() -> Fitter:
    data = data_of([recording({"armature_resistance": 4.3})], NOMINAL)
    return Fitter(data, NOMINAL, ladder(data)[0])


@pytest.fixture(scope="module")
def whole(fitter: Fitter):
    return fitter.fit(Explanation(PARAMETERS), NOMINAL.values)


def test_a_parabola_is_least_squares_with_the_others_held(whole):
    parabola = Parabola.of(whole, PARAMETERS)
    slopes = whole.fitter.slopes(whole, Explanation(PARAMETERS))
    for size in range(4):
        for drifted in itertools.combinations(range(3), size):
            held = [place for place in range(3) if place not in drifted]
            moved = whole.fitted + slopes[:, held] @ (parabola.home - parabola.point)[held]
            left = moved
            if drifted:
                left = moved - slopes[:, drifted] @ np.linalg.lstsq(slopes[:, drifted], moved, rcond=None)[0]
            assert parabola.cost(drifted)[0] == pytest.approx(float(left @ left), rel=1e-6)


def test_it_ranks_the_parameter_that_drifted_first(whole):
    assert Parabola.of(whole, PARAMETERS).best_of_size(1)[0].drifted == ("armature_resistance",)


def test_a_quantity_that_does_not_pay_is_not_chosen(fitter, whole):
    right = fitter.fit(Explanation(("armature_resistance",)), NOMINAL.values)
    described = fitter.fit(Explanation(), NOMINAL.values, 0)
    assert min((described, right, whole), key=Score.of([described, right, whole])) is right


def test_the_predictor_is_the_chosen_where_it_leaves_only_noise_and_else_the_best(fitter, whole):
    right = fitter.fit(Explanation(("armature_resistance",)), NOMINAL.values)
    described = fitter.fit(Explanation(), NOMINAL.values, 0)
    assert predictor(right, (described, right, whole)) is right
    far = fitter.fit(Explanation(), {**NOMINAL.values, "spring_preload": 0.4}, 0)
    assert predictor(far, (far, right, whole)) is not far


def test_ties_keep_the_other_quantities(fitter):
    one = fitter.fit(Explanation(("armature_resistance", "spring_preload")), NOMINAL.values, 0)
    other = fitter.fit(Explanation(("torque_constant", "spring_preload")), NOMINAL.values, 0)
    apart = fitter.fit(Explanation(("torque_constant", "coulomb_friction")), NOMINAL.values, 0)
    assert ties(one, [one, other, apart]) == {"armature_resistance": (("torque_constant",),)}


def leaving(fitter: Fitter, effects: tuple[str, ...], residual: np.ndarray):
    """A fit with some effects that leaves a residual [noise], shape (samples,)."""
    fit = fitter.fit(Explanation(), NOMINAL.values, 0)
    return replace(
        fit, explanation=Explanation((), tuple(Variant(effect, ()) for effect in effects)), residual=residual
    )


def test_of_two_effects_that_fit_alike_one_is_named_with_the_other_as_its_tie(fitter):
    random = np.random.default_rng(0)
    noise, wave = random.standard_normal((2, fitter.data.train.size))
    described = leaving(fitter, (), noise + 5.0 * wave)
    drag = leaving(fitter, ("drag",), noise + 1.5 * wave)
    lag = leaving(fitter, ("sensor_lag",), np.roll(noise, 1) + 1.5 * wave)
    worse = leaving(fitter, ("backlash",), noise + 4.9 * wave)
    ((name, found),) = sure([described, drag, lag, worse]).items()
    assert {name, found.instead} == {"drag", "sensor_lag"}
    # one that is better than the other by far is named alone
    better = leaving(fitter, ("drag",), noise + 0.3 * wave)
    ((name, found),) = sure([described, better, lag, worse]).items()
    assert (name, found.instead) == ("drag", None)
    # what takes little is not named, alone or as one of two
    little = leaving(fitter, ("drag",), noise + 4.8 * wave)
    assert not sure([described, little, worse])
