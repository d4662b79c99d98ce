"""Values cost nothing where they are expected, and the more the farther they are from what is plausible."""

import math

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import DECLARED
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.prior import KNOWN, implausible, improbability
from pierburg_ros.inference.coordinates import Coordinates
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import Model

HEAT = "thermal_resistance.heat_capacity"
SERVO = Model.nominal(read_actuator("xl330"))


def improbable(name: str, value: float, model: Model = NOMINAL) -> float:
    coordinates = Coordinates((name,), model, 60.0)
    return float(improbability(coordinates, coordinates.point({**model.values, name: value}))[0])


@pytest.mark.parametrize("model", [NOMINAL, SERVO])
def test_what_is_described_costs_nothing(model: Model) -> None:
    names = model.actuator.free
    coordinates = Coordinates(names, model, 60.0)
    assert improbability(coordinates, coordinates.point(model.values)) == pytest.approx(np.zeros(len(names)), abs=1e-9)


def test_a_base_parameter_costs_by_the_logarithm_of_its_ratio() -> None:
    own = NOMINAL.values["armature_resistance"]
    assert improbable("armature_resistance", own * math.exp(KNOWN)) == pytest.approx(1.0)
    assert improbable("armature_resistance", own * math.exp(-2.0 * KNOWN)) == pytest.approx(-2.0)


def test_an_effect_costs_by_what_its_declaration_calls_plausible() -> None:
    sag = improbable("supply_sag.source_resistance", 0.0), improbable("supply_sag.source_resistance", 1e-3)
    assert sag[0] == 0.0 and 0.0 < sag[1] < 0.01
    low, high = DECLARED[HEAT].expected(NOMINAL.scales)
    ends = improbable(HEAT, low), improbable(HEAT, high)
    assert ends == pytest.approx((-1.96, 1.96))
    assert improbable(HEAT, low / 30.0) < -4.0
    assert abs(improbable("cogging_torque.periods_per_motor_revolution", 6.0)) < 1.96


def test_moments_are_as_likely_one_as_another() -> None:
    assert improbable("external_load.start", 3.0) == improbable("external_load.start", 50.0) == 0.0


def test_a_fit_with_a_unit_gives_way_to_what_is_known() -> None:
    """Between the drift that the samples ask for and the nominal value, the nearer to this the less they count."""
    data = data_on(recording({"spring_preload": 0.4}, duration=5.0))
    found = [
        Estimator(data, NOMINAL, unit=unit).fit(Explanation(("spring_preload",))).values["spring_preload"]
        for unit in (1.0, 300.0, 1e5)
    ]
    nominal = NOMINAL.values["spring_preload"]
    assert found[0] == pytest.approx(0.4, abs=0.002)
    assert abs(found[0] - nominal) > abs(found[1] - nominal) > abs(found[2] - nominal)
    assert found[2] == pytest.approx(nominal, rel=0.01)


def test_what_no_actuator_has_is_told_by_name():
    names = ("cogging_torque.amplitude", "cogging_torque.periods_per_motor_revolution")
    coordinates = Coordinates(names, NOMINAL, 60.0)
    for periods, told in ((6.0, set()), (200.0, {names[1]})):
        point = coordinates.point({**NOMINAL.values, names[0]: 0.01, names[1]: periods})
        assert implausible(coordinates, point) == told


def test_what_may_be_0_is_too_large_but_never_too_small():
    low, high = DECLARED["gear_compliance.damping"].expected(NOMINAL.scales)
    assert improbable("gear_compliance.damping", low / 10.0) == 0.0
    assert improbable("gear_compliance.damping", high) == pytest.approx(1.96)
