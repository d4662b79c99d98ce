"""The MuJoCo export, run by MuJoCo and compared with the simulator: two programs that share no line."""

import numpy as np
import pytest
from support.acting import acting
from support.other_simulators import mujoco_angle, steps
from support.recordings import NOMINAL, recording_in_closed_loop

from pierburg_ros.actuators import read_actuator
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.decode import decoded

mujoco = pytest.importorskip("mujoco", minversion="3.13")
SAMPLES = np.arange(0.0, 6.0, 0.002)


def error(model: Model, inputs: Inputs) -> float:
    """Root mean square of MuJoCo's angle less ours [rad]."""
    ours = decoded(Model.nominal(model.actuator), simulate(model, inputs, SAMPLES))
    return float(np.sqrt(np.mean((mujoco_angle(model, inputs, SAMPLES) - ours) ** 2)))


def test_the_nominal_valve_moves_alike_under_random_duty():
    """Measured 0.03 mrad; 1 mrad is 2.6 mV of Hall voltage, below the noise of a sensor."""
    assert error(NOMINAL, steps(6.0)) < 2e-4


def test_the_nominal_valve_moves_alike_under_the_duty_of_a_closed_loop():
    """Measured 0.9 mrad: under a duty that all but moves it, MuJoCo's shaft creeps while ours stands."""
    duty = inputs_of(recording_in_closed_loop({}))
    assert error(NOMINAL, duty) < 2e-3


@pytest.mark.parametrize(
    "effect",
    ["viscous_friction", "cogging_torque", "presliding", "stop_compliance", "thermal_resistance", "input_delay"],
)
def test_an_effect_that_mujoco_holds_moves_alike(effect):
    """Measured 0.03 to 0.4 mrad, where the effects themselves move the shaft by 4 to 55 mrad."""
    assert error(NOMINAL.with_values(acting(effect)), steps(6.0)) < 1e-3


def test_a_stiffening_spring_and_a_slow_winding_move_alike():
    """The knee of the spring has no place in MuJoCo."""
    spring = NOMINAL.with_values({"nonlinear_spring.cubic_stiffness": 0.05})
    assert error(spring, steps(6.0)) < 2e-4
    assert error(NOMINAL.with_values(acting("armature_inductance")), steps(6.0)) < 2e-4


def test_sticking_harder_than_sliding_is_held_as_lugre_friction():
    """Beside the same friction with bristles of the same stiffness, which is what MuJoCo has."""
    sticking = acting("static_friction")
    bristles = {"presliding.stiffness": 326.0}
    model = NOMINAL.with_values({**sticking, **bristles})
    assert error(model, steps(6.0)) < 1e-3


def test_a_pendulum_swings_alike():
    swinging = Model.nominal(read_actuator("xl330"))
    assert error(swinging, steps(6.0, 4, (-0.8, 0.8))) < 3e-3


ROTOR = """
name: rotor
drive: current
load: none
sensor: speed
parameters:
  torque_constant: {nominal: 0.05, minimum: 0.001, maximum: 1.0, origin: made up}
  gear_ratio: {nominal: 1.0, minimum: 0.5, maximum: 2.0, origin: made up, free: false}
  coulomb_friction: {nominal: 0.01, minimum: 0.0, maximum: 1.0, origin: made up}
  total_inertia: {nominal: 0.0002, minimum: 1.0e-6, maximum: 0.1, origin: made up}
"""
AXIS = """
name: axis
motion: linear
load: none
sensor: position
stops: {lower: 0.0, upper: 0.5}
parameters:
  armature_resistance: {nominal: 1.0, minimum: 0.1, maximum: 10.0, origin: made up}
  supply_voltage: {nominal: 24.0, minimum: 1.0, maximum: 60.0, origin: made up}
  torque_constant: {nominal: 0.05, minimum: 0.001, maximum: 1.0, origin: made up}
  gear_ratio: {nominal: 600.0, minimum: 1.0, maximum: 2000.0, origin: made up, free: false}
  coulomb_friction: {nominal: 40.0, minimum: 0.0, maximum: 1000.0, origin: made up}
  total_inertia: {nominal: 6.0, minimum: 0.1, maximum: 100.0, origin: made up}
"""


@pytest.mark.parametrize("effect", ["", "viscous_friction", "static_friction"])
@pytest.mark.parametrize(("text", "reach"), [(ROTOR, (-2.0, 2.0)), (AXIS, (-0.5, 0.6))], ids=["rotor", "axis"])
def test_a_rotor_driven_by_current_and_a_linear_axis_move_alike(tmp_path, text, reach, effect):
    """Measured: within 0.02 % of the range moved, 0.4 % where the axis sticks harder than it slides."""
    (tmp_path / "own.yaml").write_text(text)
    model = Model.nominal(read_actuator(tmp_path / "own.yaml"))
    friction = model.values["coulomb_friction"]
    changes = {
        "": {},
        "viscous_friction": {"viscous_friction.coefficient": 0.01 * friction},
        "static_friction": {
            "static_friction.breakaway_torque": 1.7 * friction,
            "static_friction.stribeck_velocity": 0.5 if text == ROTOR else 0.02,
        },
    }[effect]
    model = model.with_values(changes)
    inputs = steps(4.0, 2, reach, 0.25)
    samples = SAMPLES[SAMPLES < 4.0]
    ours = simulate(model, inputs, samples)
    difference = mujoco_angle(model, inputs, samples) - ours
    assert float(np.sqrt(np.mean(difference**2))) < 0.01 * np.ptp(ours)
