"""The model below what remains: the best one alone, or what a confirmed shape was fitted to."""

from dataclasses import replace

import numpy as np
import pytest
from support.fits import found_among, made_up
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.remainder.remainder import _below, certain, unexamined
from pierburg_ros.diagnosis.remainder.shape import Shape
from pierburg_ros.diagnosis.remainder.standing import Standing
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

STIFFER = {"spring_stiffness": 0.17}
NEVER = (np.zeros(0), np.zeros(0))


def shape_on(base: Model) -> Shape:
    return Shape(base, base, 1.0, 0.5, "", NEVER)


def test_without_a_confirmed_shape_the_recalibrated_model_is_given_and_not_one_that_fits_worse():
    """A shape may be fitted to the model as described; where nothing comes of it, that model is no result."""
    found, explanation = recalibrated_on(STIFFER), Explanation(("spring_stiffness",))
    alone, below_nominal = _below(found, None), _below(found, shape_on(NOMINAL))
    assert alone.explanation == explanation and alone.values["spring_stiffness"] == 0.17
    assert below_nominal.explanation == Explanation() and below_nominal.values["spring_stiffness"] == 0.1419
    kept = _below(found, shape_on(NOMINAL.with_values({"spring_stiffness": 0.16})))
    assert kept.explanation == explanation and kept.values["spring_stiffness"] == 0.16


def test_numbers_that_unseen_samples_do_not_confirm_have_not_drifted():
    below = _below(recalibrated_on({}), None)
    assert below.explanation == Explanation() and below.values["spring_stiffness"] == 0.1419


def test_what_has_been_named_stands_where_no_time_is_left_for_the_rest():
    found, weight = recalibrated_on(STIFFER), Weight(300.0, 100.0)
    base = made_up(Explanation(variants=(Variant("sensor_lag", ("time_constant",)),)), 2.0, NOMINAL)
    told = unexamined(found, Standing(found.estimator, base, weights={"sensor_lag": weight}))
    assert told.base.explanation == base.explanation and told.weights == {"sensor_lag": weight}


def test_what_bends_has_not_drifted_where_no_time_is_left_for_its_interval():
    told = unexamined(recalibrated_on(STIFFER)).base
    assert told.explanation == Explanation() and told.model.values["spring_stiffness"] == 0.17


@pytest.mark.parametrize(("coefficient", "stays"), [(0.02, True), (0.0, False)])
def test_an_effect_that_may_as_well_not_act_is_not_told(coefficient: float, stays: bool):
    """The interval of its strength holds 0; what drifts beside it stays."""
    data = data_on(recording({**STIFFER, "viscous_friction.coefficient": coefficient}, duration=5.0))
    estimator, weight = Estimator(data, NOMINAL), Weight(300.0, 100.0)
    viscous = Variant("viscous_friction", ("coefficient",))
    base = estimator.fit(Explanation(("spring_stiffness",), (viscous,)))
    with workers(1) as pool:
        told, known = certain(Standing(estimator, base, weights={"viscous_friction": weight}), pool)
    assert told.weights == ({"viscous_friction": weight} if stays else {})
    assert told.base is not None and told.base.explanation.drifted == ("spring_stiffness",)
    assert ("viscous_friction.coefficient" in known) is stays and "spring_stiffness" in known
    assert told.base.values["spring_stiffness"] == pytest.approx(0.17, rel=0.01)


def test_where_nothing_else_stands_nothing_does():
    estimator = Estimator(data_on(recording({}, duration=5.0)), NOMINAL)
    base = estimator.fit(Explanation(variants=(Variant("viscous_friction", ("coefficient",)),)))
    with workers(1) as pool:
        told, known = certain(Standing(estimator, base, weights={"viscous_friction": Weight(300.0, 100.0)}), pool)
    assert told.base is None and not told.weights and not known


def recalibrated_on(changes: dict[str, float]) -> Found:
    """A search of the valve with `changes` whose recalibrated model has the stiffer spring."""
    recalibrated = made_up(Explanation(("spring_stiffness",)), 3.0, NOMINAL.with_values(STIFFER))
    data, nominal = data_on(recording(changes, duration=5.0)), made_up(Explanation(), 5.0, NOMINAL)
    return replace(found_among(data, recalibrated, nominal), recalibrated=recalibrated)
