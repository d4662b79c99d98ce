"""Each effect between duty and angle against its equation, written out and integrated by SciPy with events."""

from __future__ import annotations

import numpy as np
import pytest
from independent.cases import CASES, Case
from independent.event_driven import Valve, trajectory
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))


def hall_voltage(angle: np.ndarray) -> np.ndarray:
    """Nominal Hall voltage [V]."""
    return 0.42 + 4.10 * angle / (np.pi / 2)


def test_nominal_plant_follows_the_independent_integrator() -> None:
    time, duty = rich_duty()
    expected = hall_voltage(trajectory(Valve(), time, duty, time))
    assert np.ptp(expected) == pytest.approx(4.10)
    assert np.abs(simulate(NOMINAL, Inputs(time, duty), time) - expected).max() < 2e-5


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_effect_follows_its_equation(case: Case) -> None:
    time, duty = rich_duty()
    model = NOMINAL.with_values({f"{case.name}.{name}": value for name, value in case.values.items()})
    measured = simulate(model, Inputs(time, duty), time)
    expected = hall_voltage(trajectory(case.valve, time, duty, time))
    shown = np.abs(measured - simulate(NOMINAL, Inputs(time, duty), time)).max()
    assert shown > 0.001, "the excitation does not show the effect"
    assert np.abs(measured - expected).max() < 0.5e-3
