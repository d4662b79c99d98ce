"""Beside a disturbance an effect counts where unseen samples confirm it."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.diagnose import effects_stand, unseen_confirm
from pierburg_ros.estimation.data import in_parts
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant

STICKY = {"load_dependent_friction.coefficient": 0.05}
EFFECT = Explanation(variants=(Variant("load_dependent_friction", ("coefficient",)),))


DRIFT = Explanation(("armature_resistance",))


def found(really, disturbed, explanation=EFFECT, values=STICKY):
    """What a search that has chosen an explanation with these values gives of a valve that `really` has others."""
    data = replace(in_parts(data_on(recording(really))), disturbed=disturbed)
    estimator = Estimator(data, NOMINAL)
    chosen, nominal = estimator.at(explanation, values), estimator.at(Explanation())
    fits = {Explanation(): nominal}
    return SimpleNamespace(data=data, chosen=chosen, final=chosen, recalibrated=nominal, fits=fits)


@pytest.mark.parametrize(("really", "confirmed"), [(STICKY, "all"), ({}, "nothing")])
def test_an_effect_beside_a_disturbance_has_to_lower_the_error_on_samples_that_test(really, confirmed):
    assert unseen_confirm(found(really, disturbed=True)) == confirmed


def test_a_disturbance_and_what_is_beside_it_have_to_leave_nothing_on_samples_that_test():
    """What a wrong effect leaves: here that of a spring which is a little stiffer."""
    assert unseen_confirm(found({**STICKY, "spring_stiffness": 0.143}, disturbed=True)) == "nothing"


@pytest.mark.parametrize(("ohm", "confirmed"), [(4.1389, "the disturbance"), (4.4, "all")])
def test_a_parameter_beside_a_disturbance_that_is_off_by_next_to_nothing_has_not_drifted(ohm, confirmed):
    drifted = {"armature_resistance": ohm}
    assert unseen_confirm(found(drifted, True, DRIFT, drifted)) == confirmed


def test_without_a_disturbance_the_search_has_decided():
    assert unseen_confirm(found({}, disturbed=False)) == "all"


@pytest.mark.parametrize(("really", "stands"), [(STICKY, True), ({}, False)])
def test_an_effect_beside_a_disturbance_has_to_stand_beside_a_remainder_of_any_shape(really, stands):
    beside = found(really, disturbed=True)
    elsewhere = SimpleNamespace(data=beside.data, nominal=NOMINAL, estimator=Estimator(beside.data, NOMINAL))
    assert effects_stand(beside, elsewhere, lambda _: None, 1, Deadline()) == stands
