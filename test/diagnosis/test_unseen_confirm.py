"""Beside a disturbance an effect counts where unseen samples confirm it."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.diagnose import unseen_confirm
from pierburg_ros.estimation.data import in_parts
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.explanation import Explanation, Variant

STICKY = {"load_dependent_friction.coefficient": 0.05}
EFFECT = Explanation(variants=(Variant("load_dependent_friction", ("coefficient",)),))


def found(really, disturbed):
    """What a search that has chosen `EFFECT` gives of a valve that `really` has these values."""
    data = replace(in_parts(data_on(recording(really))), disturbed=disturbed)
    estimator = Estimator(data, NOMINAL)
    chosen = estimator.at(EFFECT, STICKY)
    return SimpleNamespace(data=data, chosen=chosen, final=chosen, recalibrated=estimator.at(Explanation()))


@pytest.mark.parametrize(("really", "confirmed"), [(STICKY, True), ({}, False)])
def test_an_effect_beside_a_disturbance_has_to_lower_the_error_on_samples_that_test(really, confirmed):
    assert unseen_confirm(found(really, disturbed=True)) == confirmed


def test_without_a_disturbance_the_search_has_decided():
    assert unseen_confirm(found({}, disturbed=False))
