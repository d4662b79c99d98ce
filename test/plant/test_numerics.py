"""The same input gives the same output on any number of threads; what cannot be simulated ends soon and is said."""

import time

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.comparison.compare import compare
from pierburg_ros.effects import presliding
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate, simulate_many
from pierburg_ros.plant.signal_path import BURST, SUSTAINED
from pierburg_ros.recording import Channel, Recording

NOMINAL = Model.nominal(read_actuator("pierburg"))
TIME = np.arange(251) * 0.002
STEPS = Inputs(np.arange(10) * 0.05, np.array([1.0, -0.3, 0.24, 0.0, 0.5, -1.0, 1.0, 0.1, 0.24, 0.0]))
WRINKLED = NOMINAL.with_residual(
    {"angle": [0.0, 5e-10, 1e-9], "velocity": [0.0], "torque": [[0.0], [0.01], [0.0]], "period": 1e-9}
)
"""A torque that bends in every nanoradian, for which the simulator's steps are as short."""


def models() -> list[Model]:
    changes = [
        {
            "armature_resistance": 3.0 + 0.2 * k,
            "backlash.gap": 0.01 * (k % 3),
            "thermal_resistance.thermal_resistance": 2.0 * (k % 2),
        }
        for k in range(9)
    ]
    complete = {"backlash.motor_friction_share": 0.5, "thermal_resistance.heat_capacity": 5.0}
    return [NOMINAL.with_values({**complete, **change}) for change in changes]


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_the_number_of_threads_changes_no_bit(threads):
    alone = np.array([simulate(model, STEPS, TIME) for model in models()])
    for _ in range(3):
        assert simulate_many(models(), STEPS, TIME, jobs=threads).tobytes() == alone.tobytes()


@pytest.mark.parametrize("inductance", [1e-6, 1e-9, 1e-15])
@pytest.mark.parametrize("gear", [{}, {"backlash.gap": 0.2, "backlash.motor_friction_share": 0.4}])
def test_a_winding_as_quick_as_one_likes_is_the_winding_without_inductance(gear, inductance):
    slow = NOMINAL.with_values(gear)
    quick = slow.with_values({"armature_inductance.inductance": inductance})
    apart = np.abs(simulate(quick, STEPS, TIME) - simulate(slow, STEPS, TIME))
    assert apart.max() < 10.0 * max(inductance, 1e-8)


def test_a_set_that_cannot_be_simulated_ends_and_is_not_a_number():
    began = time.process_time()
    output = simulate(WRINKLED, STEPS, TIME)
    assert np.isnan(output[-1])
    allowed = (BURST + SUSTAINED * TIME[-1]) * 20e-6  # s, an event taking twenty times its usual time
    assert time.process_time() - began < allowed


def test_a_stiff_gear_that_stands_leaning_comes_to_an_end():
    """Motor and shaft rest against each other; the angle's rounding swings on the gear for ever, and is no motion."""
    leaning = {"coulomb_friction": 1e-4, "cogging_torque.amplitude": 56.0, "cogging_torque.phase": 6.127}
    stiff, rigid = (
        simulate(NOMINAL.with_values({**leaning, "gear_compliance.stiffness": stiffness}), STEPS, TIME, 1.0)
        for stiffness in (3e4, 0.0)
    )
    assert np.abs(stiff - rigid).max() < 2.0 * 10.0 / 3e4 * 2.7  # V: what the gear gives under the strongest torque


def test_a_step_that_leads_beyond_all_numbers_is_taken_shorter():
    """From the top of a ripple's hill one step of the first length grows beyond all numbers."""
    hill = {
        "spring_preload": 8.0,
        "gear_ratio": 85.79,
        "gear_compliance.stiffness": 0.42,
        "gear_compliance.damping": 0.077,
        "cogging_torque.amplitude": 58.0,
        "cogging_torque.periods_per_motor_revolution": 381.8,
        "cogging_torque.phase": 3.64,
    }
    for angle in np.linspace(0.1, 1.4, 8):
        output = simulate(NOMINAL.with_values(hill), STEPS, TIME[:50], angle)
        assert np.all((output >= 0.42) & (output <= 4.52))


def test_the_shortest_way_that_there_is_leaves_bristles_as_they_lean():
    """As a pendulum without friction goes that comes to hang: its way over the reach of the bristles is 0."""
    bristles = NOMINAL.with_values({"presliding.stiffness": 21.0}).record()[0]["presliding"]
    assert presliding.moved(bristles, 0.0014, 90.0, 90.0, 1e-323) == 0.0014
    assert presliding.moved(bristles, 0.0014, 90.0, 80.0, 1e-323) == 0.0014


def test_a_tight_spot_as_narrow_as_one_likes_is_crossed():
    """A micron of the travel is passed in steps of its own; the travel before and after it is not."""
    spot = {"position_dependent_friction.amplitude": 5.0, "position_dependent_friction.center": 0.8}
    narrow = NOMINAL.with_values({**spot, "position_dependent_friction.width": 1e-9})
    assert np.abs(simulate(narrow, STEPS, TIME) - simulate(NOMINAL, STEPS, TIME)).max() < 1e-4


def test_samples_do_not_change_the_motion_that_they_are_read_from():
    """Elastic and parted teeth, bristles, a winding, a ripple: read every 2 ms and at the changes of the duty alone."""
    for effects in (
        {"gear_compliance.stiffness": 12.0, "gear_compliance.damping": 0.01, "presliding.stiffness": 15.0},
        {"backlash.gap": 0.2, "backlash.motor_friction_share": 0.4, "armature_inductance.inductance": 1e-5},
        {"presliding.stiffness": 15.0, "presliding.damping": 0.02, "nonlinear_spring.cubic_stiffness": 0.05},
        {"cogging_torque.amplitude": 0.02, "cogging_torque.periods_per_motor_revolution": 3.0},
        {"stop_compliance.stiffness": 30.0, "stop_compliance.damping": 0.01},
    ):
        model = NOMINAL.with_values(effects)
        dense, sparse = simulate(model, STEPS, TIME), simulate(model, STEPS, TIME[::25])
        assert np.abs(dense[::25] - sparse).max() < 1e-4


def test_a_finer_ripple_than_any_motor_has_is_refused_in_one_line():
    with pytest.raises(
        InputError, match=r"is 900 and gear_ratio 700, 630000 in one turn of the output; expected 50000"
    ):
        NOMINAL.with_values(
            {
                "cogging_torque.amplitude": 0.01,
                "cogging_torque.periods_per_motor_revolution": 900.0,
                "gear_ratio": 700.0,
            }
        )


def test_a_comparison_with_such_a_model_says_so_in_one_line():
    measured = simulate(NOMINAL, STEPS, TIME)
    recording = Recording("run", "hall_voltage", TIME, measured, Channel(STEPS.time, STEPS.command))
    with pytest.raises(InputError, match=r"The model of pierburg cannot be simulated with these values \(from "):
        compare(WRINKLED, recording)
