"""What may stand for each quantity of the chosen explanation, among fits whose errors are given."""

import pytest
from support.fits import found_among, of_chi2
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.selection import TIED
from pierburg_ros.diagnosis.verdict.ties import Alternative, alternatives
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant

VISCOUS = Variant("viscous_friction", ("coefficient",))
LAG = Variant("sensor_lag", ("time_constant",))
DELAY = Variant("input_delay", ("delay",))
LOAD = Variant("external_load", ("torque", "start", "end"))
PULSE = Variant("external_load", ("amplitude", "frequency", "phase"))
PAIR = ("armature_resistance", "torque_constant")


@pytest.fixture(scope="module")
def data() -> Data:
    return data_on(recording({}, duration=5.0))


def alike(*explanations: Explanation) -> list[Fit]:
    return [of_chi2(explanation, 0.5 * TIED, NOMINAL) for explanation in explanations]


def test_an_effect_may_be_another_one_or_a_parameter_or_two(data: Data) -> None:
    chosen = of_chi2(Explanation((), (VISCOUS,)), 0.0, NOMINAL)
    others = alike(Explanation((), (LAG,)), Explanation(("coulomb_friction",)), Explanation(PAIR))
    assert alternatives(found_among(data, chosen, *others)) == [
        Alternative(VISCOUS, ("sensor_lag",)),
        Alternative(VISCOUS, ("coulomb_friction",)),
        Alternative(VISCOUS, PAIR),
    ]


def test_what_fits_worse_is_none(data: Data) -> None:
    chosen = of_chi2(Explanation((), (VISCOUS,)), 0.0, NOMINAL)
    worse = of_chi2(Explanation((), (LAG,)), 2.0 * TIED, NOMINAL)
    assert alternatives(found_among(data, chosen, worse)) == []


def test_what_fails_on_the_validation_samples_is_none(data: Data) -> None:
    chosen = of_chi2(Explanation((), (VISCOUS,)), 0.0, NOMINAL)
    bent = of_chi2(Explanation(("spring_preload",)), 0.0, NOMINAL.with_values({"spring_preload": 0.4}))
    assert alternatives(found_among(data, chosen, bent)) == []


def test_of_several_quantities_the_one_that_is_lacking_has_the_alternative(data: Data) -> None:
    chosen = of_chi2(Explanation(("spring_preload",), (LAG,)), 0.0, NOMINAL)
    others = alike(Explanation(("spring_preload",), (DELAY,)), Explanation(("coulomb_friction",), (LAG,)))
    assert alternatives(found_among(data, chosen, *others)) == [
        Alternative(LAG, ("input_delay",)),
        Alternative("spring_preload", ("coulomb_friction",)),
    ]


@pytest.mark.parametrize(
    "other",
    [Explanation(("spring_preload",), (DELAY, VISCOUS)), Explanation(("coulomb_friction", "supply_voltage"), (LAG,))],
    ids=["two effects for one", "two parameters for one"],
)
def test_what_is_no_simpler_way_to_see_it_is_not_named(data: Data, other: Explanation) -> None:
    chosen = of_chi2(Explanation(("spring_preload",), (LAG,)), 0.0, NOMINAL)
    assert alternatives(found_among(data, chosen, *alike(other))) == []


def test_an_effect_that_an_equal_explanation_lacks_has_all_that_is_there_instead(data: Data) -> None:
    """The drift beside it differs too, and for that nothing is listed."""
    chosen = of_chi2(Explanation(("spring_preload",), (LAG, LOAD)), 0.0, NOMINAL)
    other = Explanation(("coulomb_friction",), (DELAY, LOAD))
    assert alternatives(found_among(data, chosen, *alike(other))) == [
        Alternative(LAG, ("coulomb_friction", "input_delay"))
    ]


def test_more_quantities_stand_for_no_effect(data: Data) -> None:
    chosen = of_chi2(Explanation(("spring_preload",), (LAG,)), 0.0, NOMINAL)
    larger = Explanation(PAIR, (DELAY,))
    assert alternatives(found_among(data, chosen, *alike(larger))) == []


def test_another_way_of_the_same_effect_is_the_same_effect(data: Data) -> None:
    chosen = of_chi2(Explanation((), (LOAD,)), 0.0, NOMINAL)
    assert alternatives(found_among(data, chosen, *alike(Explanation((), (PULSE,))))) == []
