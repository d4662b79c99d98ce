"""The exact simulator and the textbook formulation, two readings of one catalogue, give the same Hall voltage."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.concealment import draw
from pierburg_ros.proof.excitation import duty_sequence
from pierburg_ros.proof.formulation import simulate_textbook
from pierburg_ros.proof.formulation.values import CATALOGUE

AGREEMENT = 0.001  # V; both claim about half of it for themselves
NOMINAL = Model.nominal(read_actuator("pierburg"))


def difference(values, seed, holdout=False):
    """Absolute difference of the two simulations [V] under one drawn duty sequence."""
    time = np.arange(10000) / 500.0
    duty = duty_sequence(time, np.random.default_rng(seed), holdout)
    exact = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    return np.abs(exact - simulate_textbook(values, time, duty))


# A converter amplifies any difference to a whole step, so it is compared below, apart from the others.
@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("effect", [e for e in CATALOGUE if e != "sensor_quantization"])
def test_every_effect_alone(effect, number):
    trial = draw(effect, number, 77)
    assert difference({**trial.drifted, **trial.effects}, number, holdout=number > 1).max() < AGREEMENT


@pytest.mark.parametrize("number", range(12))
def test_two_effects_together(number):
    trial = draw("two", number, 78)
    apart = difference({**trial.effects, "sensor_quantization.step": 0.0}, number)
    assert apart.max() < AGREEMENT


def test_the_converter_differs_in_hardly_any_sample():
    apart = difference({"sensor_quantization.step": 0.02}, 3)
    assert apart.max() < 0.02 + 1e-9
    assert np.mean(apart > 1e-9) < 0.001
