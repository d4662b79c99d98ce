"""Current and torque drives, free rotors and speed sensors, against closed forms and another integrator."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pierburg_ros.actuators import actuator_of, read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.simulate import motor_torque

ROTOR = Model.nominal(read_actuator("odrive"))
PENDULUM = Model.nominal(read_actuator("ak80"))
TIME = np.arange(0.0, 2.0, 0.002)
UP_AND_DOWN = Inputs(np.array([0.0, 0.5, 1.0]), np.array([1.0, 0.0, -2.0]))
PER_AMPERE = 0.0306


def described(kind: Mapping[str, Any], numbers: Mapping[str, float]) -> Model:
    """A model of an actuator with these nominal `numbers`."""
    parameters = {
        name: {"nominal": n, "minimum": 0.0, "maximum": 100.0, "origin": "test"} for name, n in numbers.items()
    }
    for name in ("total_inertia", "torque_constant", "gear_ratio", "armature_resistance"):
        if name in parameters:
            parameters[name]["minimum"] = 1e-6
    return Model.nominal(actuator_of({"name": "made", **kind, "parameters": parameters}, "made"))


def rotating(torque: float, friction: float, inertia: float, time: np.ndarray, start: float = 0.0) -> np.ndarray:
    """Velocity under a constant torque against Coulomb friction, until it stands and cannot start again."""
    direction = math.copysign(1.0, start if start != 0.0 else torque)
    if start == 0.0 and abs(torque) <= friction:
        return np.zeros(time.size)
    velocity = start + (torque - direction * friction) / inertia * time
    if start != 0.0 and abs(torque) <= friction:
        velocity = np.where(velocity * direction > 0.0, velocity, 0.0)
    return velocity


def test_a_free_rotor_under_steps_of_current_is_the_closed_form() -> None:
    angle = simulate(ROTOR, UP_AND_DOWN, TIME)
    first = rotating(PER_AMPERE, 0.02, 2.5e-4, TIME[:251])
    assert np.abs(angle[:251] - 0.5 * first * TIME[:251]).max() < 1e-9
    # it coasts to rest within 0.265 s: (0.0306 - 0.02) / 0.02 of the time it ran
    speed = first[-1]
    coasted = angle[500] - angle[250]
    assert coasted == pytest.approx(speed**2 * 2.5e-4 / (2.0 * 0.02), abs=1e-9)
    assert angle[400] == angle[500]
    last = rotating(-2.0 * PER_AMPERE, 0.02, 2.5e-4, TIME[:500])
    assert np.abs(angle[500:] - angle[500] - 0.5 * last * TIME[:500]).max() < 1e-7


def test_a_rotor_without_friction_keeps_its_speed() -> None:
    free = ROTOR.with_values({"coulomb_friction": 0.0})
    angle = simulate(free, Inputs(np.zeros(1), np.zeros(1)), TIME, 0.3, 7.0)
    assert np.abs(angle - 0.3 - 7.0 * TIME).max() < 1e-9


def test_no_current_brakes_nothing_and_an_open_bridge_is_the_same_as_none() -> None:
    free = ROTOR.with_values({"coulomb_friction": 0.0})
    driven = Inputs(np.array([0.0, 1.0]), np.array([0.5, 0.5]), enabled=np.array([True, False]))
    none = Inputs(np.array([0.0, 1.0]), np.array([0.5, 0.0]))
    assert np.array_equal(simulate(free, driven, TIME), simulate(free, none, TIME))


def test_the_energy_of_a_pendulum_without_friction_stays() -> None:
    free = PENDULUM.with_values({"coulomb_friction": 0.0, "viscous_friction.coefficient": 0.0})
    time = np.arange(0.0, 20.0, 0.001)
    angle = simulate(free, Inputs(np.zeros(1), np.zeros(1)), time, 2.5)
    velocity = np.gradient(angle, 0.001)[5:-5]
    energy = 0.5 * 0.147 * velocity**2 - 2.984 * np.cos(angle[5:-5])
    # central differences of the angle are wrong by 0.1 % of a part in a thousand of the swing
    assert np.ptp(energy) < 2e-4 * 2.984


@pytest.mark.parametrize("scale", [1.0, 0.8])
def test_a_damped_pendulum_under_torque_is_that_of_another_integrator(scale: float) -> None:
    damped = PENDULUM.with_values({"coulomb_friction": 0.0, "torque_scale": scale})
    command = 1.5 * np.sin(7.0 * TIME)

    def slope(time: float, state: np.ndarray) -> list[float]:
        torque = scale * command[max(int(np.searchsorted(TIME, time, side="right")) - 1, 0)]
        return [state[1], (torque - 2.984 * math.sin(state[0]) - 0.0471 * state[1]) / 0.147]

    expected = _in_steps(slope, TIME, np.zeros(2))
    assert np.abs(simulate(damped, Inputs(TIME, command), TIME) - expected[:, 0]).max() < 2e-5


def _in_steps(slope: Callable[..., list[float]], time: np.ndarray, state: np.ndarray) -> np.ndarray:
    """The states at `time`, integrated from one change of the input to the next."""
    found = [state]
    for start, end in pairwise(time):
        middle = 0.5 * (start + end)
        solved = solve_ivp(lambda _, x, at=middle: slope(at, x), (start, end), found[-1], rtol=1e-9, atol=1e-11)
        found.append(solved.y[:, -1])
    return np.array(found)


def test_a_gear_multiplies_the_torque_of_a_current() -> None:
    kind = {"drive": "current", "load": "none", "sensor": "position"}
    numbers = {"torque_constant": 0.05, "gear_ratio": 20.0, "coulomb_friction": 0.0, "total_inertia": 0.5}
    angle = simulate(described(kind, numbers), Inputs(np.zeros(1), np.array([0.3])), TIME)
    assert np.abs(angle - 0.5 * (0.05 * 20.0 * 0.3 / 0.5) * TIME**2).max() < 1e-9


def test_a_speed_sensor_shows_the_velocity_with_scale_offset_and_lag() -> None:
    kind = {"drive": "torque", "load": "none", "sensor": "speed"}
    model = described(kind, {"coulomb_friction": 0.0, "total_inertia": 0.5})
    steady = Inputs(np.zeros(1), np.array([0.25]))
    assert np.abs(simulate(model, steady, TIME) - 0.5 * TIME).max() < 1e-9
    off = model.with_values({"sensor_scale": 1.1, "sensor_offset": -0.2})
    assert np.abs(simulate(off, steady, TIME) - (0.55 * TIME - 0.2)).max() < 1e-9
    late = simulate(model.with_values({"sensor_lag.time_constant": 0.05}), steady, TIME)
    lagged = 0.5 * (TIME - 0.05 * (1.0 - np.exp(-TIME / 0.05)))
    assert np.abs(late - lagged).max() < 1e-6
    stepped = simulate(model.with_values({"sensor_quantization.step": 0.1}), steady, TIME)
    assert np.abs(stepped / 0.1 - np.round(stepped / 0.1)).max() < 1e-9


@pytest.mark.parametrize(
    ("model", "change", "why"),
    (
        (
            ROTOR,
            {"supply_sag.source_resistance": 0.1},
            "it needs a voltage drive, and the actuator has a current drive",
        ),
        (ROTOR, {"stop_compliance.stiffness": 10.0}, "it needs stops, and the actuator has none"),
        (PENDULUM, {"backlash.gap": 0.01}, "it needs a voltage or current drive, and the actuator has a torque drive"),
        (PENDULUM, {"nonlinear_spring.cubic_stiffness": 0.1}, "it needs a spring load, and the actuator has a pend"),
    ),
)
def test_what_cannot_act_is_refused_with_the_reason(model: Model, change: dict[str, float], why: str) -> None:
    with pytest.raises(InputError, match=why):
        model.with_values(change)


def test_cogging_under_a_torque_counts_by_turns_of_the_output() -> None:
    change = {"cogging_torque.amplitude": 0.5, "cogging_torque.periods_per_motor_revolution": 4.0}
    rippled = PENDULUM.with_values({**change, "coulomb_friction": 0.0, "viscous_friction.coefficient": 0.0})

    def slope(_: float, state: np.ndarray) -> list[float]:
        return [state[1], -(2.984 * math.sin(state[0]) + 0.5 * math.sin(4.0 * state[0])) / 0.147]

    angle = simulate(rippled, Inputs(np.zeros(1), np.zeros(1)), TIME, 1.0)
    expected = solve_ivp(slope, (0.0, TIME[-1]), [1.0, 0.0], t_eval=TIME, rtol=1e-10, atol=1e-12).y[0]
    # a step may be wrong by 1e-4 of its travel, and 20 rad are travelled
    assert np.abs(angle - expected).max() < 1e-4


def test_the_torque_of_a_voltage_is_that_of_a_dc_motor() -> None:
    """Stall torque k_g k_m V / R, none at the speed whose back-EMF is the voltage, none with an open bridge."""
    model = Model.nominal(read_actuator("pierburg"))
    constant, resistance = 37.3 * 0.022, 4.139
    open_last = Inputs(np.arange(3.0), np.array([0.0, 0.5, 0.5]), np.full(3, 12.0), np.array([True, True, False]))
    at = np.array([0.5, 1.5, 2.5])
    stall = constant * 6.0 / resistance
    assert motor_torque(model, open_last, at) == pytest.approx([0.0, stall, 0.0])
    assert motor_torque(model, open_last, at, 6.0 / constant) == pytest.approx([-stall, 0.0, 0.0], abs=1e-12)
    own = motor_torque(model, Inputs(np.zeros(1), np.ones(1)), np.zeros(1))
    assert own == pytest.approx([constant * 13.5 / resistance])
