"""Sets stiff beyond any step, or whose torques balance at several velocities, come to what their limits say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.gear.shaft import settled
from pierburg_ros.plant.motion.events import STEP_TOLERANCE
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state
from pierburg_ros.plant.torques.load import blurred

NOMINAL = Model.nominal(read_actuator("pierburg"))
SUPPLY, RESISTANCE, CONSTANT = 13.5, 4.139, 37.3 * 0.022
PRELOAD, SPRING, INERTIA = 0.29, 0.1419, 2.4602e-6
SPAN = 4.10 / (math.pi / 2)  # V/rad
TIME = np.arange(251) * 0.002
STEPS = Inputs(np.arange(10) * 0.05, np.array([1.0, -0.3, 0.24, 0.0, 0.5, -1.0, 1.0, 0.1, 0.24, 0.0]))


def test_elastic_teeth_against_elastic_stops_follow_their_equation() -> None:
    """Against SciPy's Radau, the shaft at the velocity at which its torques balance; the stops are hit and left."""
    teeth, loose, stop, damper = 12.0, 0.02, 8000.0, 30.0
    values = {
        "coulomb_friction": 0.0,
        "gear_compliance.stiffness": teeth,
        "gear_compliance.damping": loose,
        "stop_compliance.stiffness": stop,
        "stop_compliance.damping": damper,
    }

    def shaft(motor: float, speed: float, angle: float) -> float:
        push = teeth * (motor - angle) + loose * speed - PRELOAD - SPRING * angle
        for depth, way in ((angle - math.pi / 2, 1.0), (-angle, -1.0)):
            pressed = (push - way * stop * depth) / (loose + damper)
            if depth > 0.0 and stop * depth + way * damper * pressed > 0.0:
                return pressed
        return push / loose

    def equation(time: float, state: np.ndarray, duty: float) -> list[float]:
        motor, speed, angle = state
        velocity = shaft(motor, speed, angle)
        drive = CONSTANT * (duty * SUPPLY - CONSTANT * speed) / RESISTANCE
        return [speed, (drive - teeth * (motor - angle) - loose * (speed - velocity)) / INERTIA, velocity]

    changes, duties = [0.0, 0.3, 0.6], [0.6, -0.2, 0.3]
    time = np.arange(0.0, 0.9, 0.01)
    state, expected = np.array([0.5, 0.0, 0.5]), []
    for begin, end, duty in zip(changes, [*changes[1:], 0.9], duties, strict=True):
        inside = time[(time >= begin - 1e-9) & (time < end - 1e-9)]
        run = solve_ivp(equation, (begin, end), state, "Radau", inside, args=(duty,), rtol=1e-8, atol=1e-10)
        expected.append(run.y[2])
        state = solve_ivp(equation, (begin, end), state, "Radau", args=(duty,), rtol=1e-8, atol=1e-10).y[:, -1]
    angle = np.concatenate(expected)
    assert angle.max() > math.pi / 2
    assert angle.min() < 0.0
    found = simulate(NOMINAL.with_values(values), Inputs(np.array(changes), np.array(duties)), time, 0.5)
    assert np.abs(found - 0.42 - SPAN * angle).max() < 0.2e-3


def test_a_load_that_slams_the_shaft_shut_leaves_it_there() -> None:
    """Teeth that give, and a spring of 1e5 N.m: shut within any step, and then at rest on the stop."""
    slammed = {
        "nonlinear_spring.knee_stiffness": 220.0,
        "nonlinear_spring.knee_angle": -900.0,
        "gear_compliance.stiffness": 4.6,
    }
    output = simulate(NOMINAL.with_values(slammed), STEPS, TIME, 1.2)
    assert np.all(output[1:] == output[1])
    assert output[1] == pytest.approx(0.42, abs=1e-12)


@pytest.mark.parametrize("start", [0.0, 0.1, 6.0, 40.0])
@pytest.mark.parametrize("push", [0.1, 0.205, 0.28, 0.36, 0.45])
def test_a_shaft_goes_to_the_next_balance_on_its_way(start: float, push: float) -> None:
    """Friction that falls faster than the teeth damp: the first root beyond the velocity it has, found by a scan."""
    breakaway, scale, slack = 0.35, 3.0, 0.01
    model = NOMINAL.with_values(
        {
            "static_friction.breakaway_torque": breakaway,
            "static_friction.stribeck_velocity": scale,
            "spring_preload": 0.0,
            "gear_compliance.stiffness": 10.0,
        }
    )
    record = model.record()
    state = new_state(record, 0.0, 1.0)

    def left(velocity: float) -> float:
        return push - slack * velocity - 0.2007 - (breakaway - 0.2007) * math.exp(-((velocity / scale) ** 2))

    way = math.copysign(1.0, left(start))
    scan = start + way * np.arange(0.0, 100.0, 1e-3)
    passed = next(k for k in range(1, scan.size) if left(scan[k]) * way <= 0.0)
    expected = brentq(left, *sorted(scan[passed - 1 : passed + 1]))
    found = settled(record[0], state[0], push, slack, 0.0, start, 0.0, 0.0, 0.0)[0]
    assert found == pytest.approx(expected, abs=1e-6)


def test_stick_and_slip_behind_elastic_teeth_is_that_of_a_shaft_of_next_to_no_mass() -> None:
    """Dragged by a heavy motor; beside SciPy with a shaft of a hundred-millionth of its inertia.

    Mass delays each jump: the mean difference is 1.8e-3 rad with a millionth and 1.2e-4 with this, as mass^(2/3).
    """
    breakaway, scale, teeth, loose, heavy, speed = 0.45, 2.0, 5.0, 0.012, 0.05, 3.0
    values = {
        "static_friction.breakaway_torque": breakaway,
        "static_friction.stribeck_velocity": scale,
        "spring_preload": 0.0,
        "spring_stiffness": 0.0,
        "total_inertia": heavy,
        "gear_compliance.stiffness": teeth,
        "gear_compliance.damping": loose,
    }
    light = 1e-8 * heavy

    def friction(velocity: float) -> float:
        return 0.2007 + (breakaway - 0.2007) * math.exp(-((velocity / scale) ** 2))

    def equation(time: float, state: np.ndarray, slides: bool) -> list[float]:
        motor, fast, angle, velocity = state
        push = teeth * (motor - angle) + loose * (fast - velocity)
        return [fast, -push / heavy, velocity, (push - friction(velocity)) / light if slides else 0.0]

    def loosens(time: float, state: np.ndarray, slides: bool) -> float:
        return teeth * (state[0] - state[2]) + loose * state[1] - breakaway

    def rests(time: float, state: np.ndarray, slides: bool) -> float:
        return state[3] if time > begun + 1e-5 else 1.0

    rests.terminal = loosens.terminal = True  # type: ignore[attr-defined]
    begun, slides, state, slips = 0.0, False, np.array([0.3, speed, 0.3, 0.0]), 0
    time = np.arange(0.0, 0.2, 0.01)
    expected = np.full(time.size, np.nan)
    while begun < 0.2 - 1e-6:
        run = solve_ivp(
            equation, (begun, 0.2), state, "Radau", events=rests if slides else loosens, args=(slides,),
            rtol=1e-8, atol=1e-10, dense_output=True,
        )  # fmt: skip
        inside = (time >= begun) & (time <= run.t[-1])
        expected[inside] = [run.sol(moment)[2] for moment in time[inside]]
        begun, state, slides, slips = run.t[-1], run.y[:, -1], not slides, slips + slides
        state[3] = 1e-9 if slides else 0.0
    assert slips >= 3
    record = NOMINAL.with_values(values).record()
    moving = new_state(record, 0.3)
    moving["motor_velocity"], moving["motor_direction"] = speed, 1.0
    found = [0.3]
    for _ in time[1:]:
        advance(record[0], moving[0], 0.0, np.nan, False, 0.01)
        found.append(float(moving["angle"][0]))
    assert np.mean(np.abs(np.array(found) - expected)) < 2e-4


@pytest.mark.parametrize("stiffness", [3e4, 1e6])
def test_bristles_under_friction_that_fades_away_are_none(stiffness: float) -> None:
    """Friction of a tight spot alone, a few widths away next to nothing: there the shaft moves as without any."""
    spot = {
        "coulomb_friction": 0.0,
        "position_dependent_friction.amplitude": 0.05,
        "position_dependent_friction.center": 0.5,
        "position_dependent_friction.width": 0.02,
    }
    bristles = {"presliding.stiffness": stiffness, "presliding.damping": 2.0}
    rough, smooth = (simulate(NOMINAL.with_values(each), STEPS, TIME) for each in ({**spot, **bristles}, spot))
    assert np.abs(rough - smooth).max() < 2e-3


def test_bristles_that_lean_one_way_alone_let_go_the_other() -> None:
    """Closing rubs ten thousand times harder than opening; stiff bristles are the rigid contact, to what they give."""
    contact = {"coulomb_friction": 1e-4, "direction_dependent_friction.coulomb_difference": 1.0}
    bristles = {"presliding.stiffness": 3e4, "presliding.damping": 0.004}
    soft, rigid = (simulate(NOMINAL.with_values(each), STEPS, TIME) for each in ({**contact, **bristles}, contact))
    assert np.abs(soft - rigid).max() < 20.0 * SPAN / 3e4


@pytest.mark.parametrize("inductance", [0.0, 0.05])
@pytest.mark.parametrize("source", [0.0, 1.5])
def test_a_winding_without_heat_capacity_is_as_warm_as_it_loses_heat(inductance: float, source: float) -> None:
    """Pressed against the open stop: rise = R_th R (1 + 0.0039 rise) (V / (R (1 + 0.0039 rise) + d^2 R_s))^2."""
    loss, duty = 3e4, 0.6
    record = NOMINAL.with_values(
        {
            "thermal_resistance.thermal_resistance": loss,
            "armature_inductance.inductance": inductance,
            "supply_sag.source_resistance": source,
        }
    ).record()
    state = new_state(record, math.pi / 2)
    for _ in range(300):
        advance(record[0], state[0], duty, np.nan, True, 0.002)

    def gained(rise: float) -> float:
        hot = RESISTANCE * (1.0 + 0.0039 * rise)
        return loss * hot * (duty * SUPPLY / (hot + duty * duty * source)) ** 2 - rise

    assert state["thermal_resistance"]["rise"][0] == pytest.approx(brentq(gained, 0.0, 1e7), rel=1e-6)


def test_a_ripple_that_no_sensor_sees_is_passed_over() -> None:
    """At eighty times full speed six million periods pass in a second: the motion is that without it."""
    free = {"spring_stiffness": 0.0, "spring_preload": 0.0, "coulomb_friction": 0.0, "total_inertia": 1e-3}
    ripple = {
        "cogging_torque.amplitude": 5.0,
        "cogging_torque.periods_per_motor_revolution": 1000.0,
        "viscous_friction.coefficient": 0.01,
    }
    smooth = {**ripple, "cogging_torque.amplitude": 0.0}
    shaken, even = (NOMINAL.with_values({**free, **each}) for each in (ripple, smooth))
    off = Inputs(np.array([0.0]), np.array([0.0]), enabled=np.array([False]))
    time = np.linspace(0.0, 1.2e-3, 7)
    apart = simulate(shaken, off, time, 0.1, 1100.0) - simulate(even, off, time, 0.1, 1100.0)
    assert blurred(shaken.record()[0], 1100.0)
    assert not blurred(shaken.record()[0], 13.0)
    assert np.abs(apart).max() < 1e-4


def test_a_shaft_that_falls_away_from_a_motor_at_rest_does_so() -> None:
    """A heavy pendulum in oil, parted from its motor by the play: a first step of next to nothing is no end."""
    pendulum = Model.nominal(read_actuator("xl330")).with_values(
        {
            "gravity_torque": 4.275e-4,
            "coulomb_friction": 7.961e-5,
            "total_inertia": 0.9129,
            "viscous_friction.coefficient": 10.95,
            "backlash.gap": 0.2259,
            "backlash.motor_friction_share": 8.453e-7,
        }
    )
    still = Inputs(np.array([0.0]), np.array([0.0]))
    time = np.linspace(0.0, 0.5, 11)
    output = simulate(pendulum, still, time, -0.5328)
    velocity = (4.275e-4 * math.sin(0.5328) - 7.961e-5) / 10.95
    assert np.abs(output - output[0] - velocity * time).max() < 0.2 * velocity * time[-1]


@pytest.mark.parametrize(("before", "after"), [(0.163, 0.12), (0.163, 0.115), (0.2, 0.13), (0.13, 0.163)])
def test_a_jump_of_the_duty_while_the_shaft_creeps_is_as_exact_as_any_step(before: float, after: float) -> None:
    """Within 15 us the motor settles on the falling part of the Stribeck curve, and a tick of 2 ms goes on from there.

    From one velocity [rad/s] at which torques balance to about another one, against LSODA.
    """
    model = NOMINAL.with_values(
        {"static_friction.breakaway_torque": 0.2665, "static_friction.stribeck_velocity": 0.059}
    )
    start, coulomb = 0.1, model.values["coulomb_friction"]

    def resisting(angle: float, velocity: float) -> float:
        excess = (0.2665 - coulomb) * math.exp(-((velocity / 0.059) ** 2))
        return SPRING * angle + PRELOAD + coulomb + excess + CONSTANT**2 * velocity / RESISTANCE

    driving = resisting(start, after)
    duty = driving * RESISTANCE / (CONSTANT * SUPPLY)

    def motion(_: float, state: np.ndarray) -> tuple[float, float]:
        return state[1], (driving - resisting(state[0], state[1])) / INERTIA

    time = np.linspace(0.0, 0.002, 21)
    exact = solve_ivp(motion, (0.0, 0.002), [start, before], "LSODA", time, rtol=1e-12, atol=1e-14).y[0]
    hall = simulate(model, Inputs(np.array([0.0, 0.002]), np.full(2, duty)), time, start, before)
    assert np.abs((hall - hall[0]) / SPAN - (exact - start)).max() < STEP_TOLERANCE * math.pi / 2.0
