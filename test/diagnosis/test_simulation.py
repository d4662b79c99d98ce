"""The user's own simulator as nominal model: MuJoCo where it is installed, else SciPy on equations of its own."""

from importlib.util import find_spec

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.acting import acting
from support.other_simulators import mujoco_angle, steps
from support.recordings import NOISE, NOMINAL, recording

from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.simulation import as_measured
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording import Channel, Recording

TIME = np.arange(0.0, 24.0, 0.002)
OWN = {"armature_resistance": 4.4, "viscous_friction.coefficient": 0.02}
"""The simulator's own numbers: not those of the description, and a friction that the description lacks."""


def simulated(model: Model, seed: int = 7) -> Recording:
    """What the user's simulator makes of a duty that the real actuator never had; it gives the angle, without noise."""
    inputs = steps(24.0, seed, (-0.05, 0.4), 0.7)
    angle = mujoco_angle(model, inputs, TIME) if find_spec("mujoco") else smoothed_angle(model, inputs)
    return Recording("mine.csv", "position", TIME, angle, Channel(inputs.time, inputs.command))


def smoothed_angle(model: Model, inputs: Inputs) -> np.ndarray:
    """Angle [rad] of the valve with friction smoothed by a hyperbolic tangent, as simple simulators have it."""
    p = model.values
    constant = p["gear_ratio"] * p["torque_constant"]
    damping = constant**2 / p["armature_resistance"] + p["viscous_friction.coefficient"]

    def velocity(volts: float, angle: float) -> float:
        push = constant * volts / p["armature_resistance"] - p["spring_preload"] - p["spring_stiffness"] * angle
        free = np.sign(push) * max(abs(push) - p["coulomb_friction"], 0.0) / damping
        return 0.0 if (angle <= 0.0 and free < 0.0) or (angle >= np.pi / 2 and free > 0.0) else free

    angles, angle = np.empty(TIME.size), 0.0
    place = np.searchsorted(inputs.time, TIME + 1e-9, side="right") - 1
    for index, volts in enumerate(inputs.command[place] * p["supply_voltage"]):
        angles[index] = angle
        solved = solve_ivp(lambda _, y, u=volts: [velocity(u, y[0])], (0.0, 0.002), [angle], "RK23", max_step=5e-4)
        angle = float(np.clip(solved.y[0, -1], 0.0, np.pi / 2))
    return angles


@pytest.fixture(scope="module")
def mine() -> Recording:
    """A recording of the user's simulator."""
    return simulated(NOMINAL.with_values(OWN))


@pytest.mark.search
def test_an_effect_that_the_simulator_lacks_is_named(mine):
    real = recording({**OWN, **acting("static_friction")}, seed=5)
    result = diagnose([real], NOMINAL, simulation=[mine])
    found = result.diagnosis
    assert found.verdict == "missing_physics"
    assert [effect.id for effect in found.effects] == ["static_friction"]
    assert found.effects[0].parameters["breakaway_torque"].value == pytest.approx(0.27, abs=0.03)
    assert not any(parameter.drifted for parameter in found.parameters.values())
    assert found.summary.startswith("Held against your simulator, not against the description: our equations reproduce")
    assert found.simulation.recordings == ["mine.csv"]
    assert found.simulation.rmse < 0.2 * NOISE < found.simulation.described_rmse
    assert result.model.actuator == NOMINAL.actuator
    assert result.model.values["static_friction.breakaway_torque"] == pytest.approx(0.27, abs=0.03)


@pytest.mark.search
def test_what_the_simulator_has_and_the_description_lacks_is_not_named(mine):
    found = diagnose([recording(OWN, seed=6)], NOMINAL, simulation=[mine]).diagnosis
    assert found.verdict == "consistent" and not found.effects
    assert found.fit.training.nominal_rmse == pytest.approx(NOISE, rel=0.05)


@pytest.mark.search
def test_a_crude_simulator_makes_nothing_missing(mine):
    """Its time is stretched and squeezed by up to 8 ms, which our equations cannot do, nor does the real valve.

    What is between the two simulators stays between them, but for half a per cent of a parameter.
    """
    angle = as_measured(mine, NOMINAL).measured
    crude = np.interp(TIME - 0.004 * (1.0 + np.sin(0.9 * TIME)), TIME, angle)
    odd = Recording("odd.csv", "hall_voltage", TIME, crude, mine.command)
    found = diagnose([recording(OWN, seed=6, duration=12.0)], NOMINAL, simulation=[odd]).diagnosis
    assert found.verdict in {"consistent", "parameter_drift"}, found.summary
    assert not found.effects
    assert found.simulation.rmse > NOISE


def test_an_angle_is_what_a_right_sensor_shows_of_it():
    mine = Recording("mine.csv", "position", TIME[:3], np.array([0.0, np.pi / 4, np.pi / 2]), Channel([0.0], [0.0]))
    assert as_measured(mine, NOMINAL).measured == pytest.approx([0.42, 2.47, 4.52])


def test_a_simulator_that_does_not_give_what_is_measured_is_refused():
    mine = Recording("mine.csv", "speed", TIME[:3], np.array([0.0, 0.1, 0.2]), Channel([0.0], [0.0]))
    with pytest.raises(InputError, match=r"mine.csv, given as simulation, holds speed, but actuator pierburg measures"):
        as_measured(mine, NOMINAL)
