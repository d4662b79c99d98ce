"""The scales of an actuator are those of its signals, in whatever units they are given."""

import math
from dataclasses import replace

import pytest

from pierburg_ros.actuators import SHIPPED, Actuator, NominalParameter, Scales, read_actuator
from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.effects import DECLARED

VALVE = read_actuator("pierburg")
POWERS = {
    # of torque, of time, of angle
    "armature_resistance": (-1, 1, -1),
    "torque_constant": (0, 1, -1),
    "spring_stiffness": (1, 0, -1),
    "spring_preload": (1, 0, 0),
    "coulomb_friction": (1, 0, 0),
    "total_inertia": (1, 2, -1),
}
"""Powers with which each number grows where all torques, times and angles do, and voltages do not."""


def regauged(actuator: Actuator, torque: float, time: float, angle: float) -> Actuator:
    """The same actuator in other units."""

    def scaled(parameter: NominalParameter) -> NominalParameter:
        powers = POWERS.get(parameter.name, (0, 0, 0))
        return replace(
            parameter, default=parameter.nominal * torque ** powers[0] * time ** powers[1] * angle ** powers[2]
        )

    return replace(
        actuator,
        parameters={name: scaled(parameter) for name, parameter in actuator.parameters.items()},
        lower_stop=actuator.lower_stop * angle,
        upper_stop=actuator.upper_stop * angle,
    )


def test_the_scales_of_the_valve_are_what_its_motor_can_do() -> None:
    scales = Scales.of(VALVE)
    per_current = 37.3 * 0.022
    assert scales.torque == pytest.approx(per_current * 13.5 / 4.139)
    assert scales.angle == pytest.approx(math.pi / 2)
    assert scales.time == pytest.approx(math.pi / 2 * per_current / 13.5)
    assert scales.reading == pytest.approx(4.52 - 0.42)


def test_a_unit_is_the_product_of_its_parts() -> None:
    scales = Scales(2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0)
    assert scales.of_unit("1") == 1.0
    assert scales.of_unit("N.m.s/rad") == pytest.approx(2.0 * 5.0 / 3.0)
    assert scales.of_unit("N.m/rad^3") == pytest.approx(2.0 / 27.0)
    assert scales.of_unit("kg.m^2") == pytest.approx(2.0 * 25.0 / 3.0)
    assert scales.of_unit("K/W") == pytest.approx(13.0 / 77.0)
    assert scales.of_unit("J/K") == pytest.approx(77.0 * 5.0 / 13.0)
    assert scales.of_unit("H") == pytest.approx(scales.of_unit("ohm") * 5.0)
    assert scales.of_unit("reading") == 17.0


@pytest.mark.parametrize("unit", sorted({p.unit for p in DECLARED.values()} | {unit for unit, _ in UNITS.values()}))
def test_every_declared_unit_has_a_scale(unit: str) -> None:
    assert Scales.of(VALVE).of_unit(unit) > 0.0


POSITION = replace(VALVE, quantity="position")
WITHOUT_STOPS = replace(POSITION, lower_stop=-math.inf, upper_stop=math.inf)
FREE = replace(WITHOUT_STOPS, parameters={k: v for k, v in VALVE.parameters.items() if k != "spring_stiffness"})


@pytest.mark.parametrize("actuator", [POSITION, WITHOUT_STOPS, FREE], ids=["stops", "spring", "free"])
@pytest.mark.parametrize(("torque", "time", "angle"), [(100.0, 1.0, 1.0), (1.0, 10.0, 1.0), (0.01, 0.1, 20.0)])
def test_the_scales_are_those_of_the_units(actuator: Actuator, torque: float, time: float, angle: float) -> None:
    before, after = Scales.of(actuator), Scales.of(regauged(actuator, torque, time, angle))
    assert after.torque == pytest.approx(before.torque * torque)
    assert after.angle == pytest.approx(before.angle * angle)
    assert after.time == pytest.approx(before.time * time)
    assert after.voltage == pytest.approx(before.voltage)
    assert after.current == pytest.approx(before.current * torque * angle / time)
    assert after.reading == pytest.approx(before.reading * angle)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_shipped_actuators_have_scales(name: str) -> None:
    scales = Scales.of(read_actuator(name))
    assert all(0.0 < scales.of_unit(unit) < math.inf for unit, _ in UNITS.values())
