"""Stretches whose beginnings are fitted: what nothing brings back is simulated down to its noise, and identified."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.run import run_of
from pierburg_ros.estimation.shooting import FEWEST, Shooting, forgets, stretch_length
from pierburg_ros.identification.identify import identify
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

PENDULUM = Model.nominal(read_actuator("ak80"))
ROTOR = Model.nominal(read_actuator("odrive"))
NOISE = 0.001


def swung(model: Model, duration: float = 12.0, seed: int = 0, most: float = 2.5) -> Recording:
    """Steps of torque, 2.5 N.m carry the pendulum around; 1 mrad of noise."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 0.004)
    torque = random.uniform(-most, most, int(duration / 0.4) + 1)[(time / 0.4).astype(int)]
    angle = simulate(model, Inputs(time, torque), time)
    noisy = angle + NOISE * random.standard_normal(time.size)
    return Recording("swing", "position", time, noisy, Channel(time, torque), input="torque")


def turned(model: Model, duration: float = 6.0, seed: int = 0) -> Recording:
    """Steps of current both ways on a free rotor, 0.1 mrad of noise."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 0.002)
    current = random.uniform(-1.5, 1.5, int(duration / 0.1) + 1)[(time / 0.1).astype(int)]
    angle = simulate(model, Inputs(time, current), time) + 1e-4 * random.standard_normal(time.size)
    return Recording("turns", "position", time, angle, Channel(time, current), input="current")


def test_a_spring_or_a_closed_bridge_forgets_and_others_do_not() -> None:
    kinds = {name: forgets(read_actuator(name)) for name in ("pierburg", "xl330", "ak80", "odrive")}
    assert kinds == {"pierburg": True, "xl330": True, "ak80": False, "odrive": False}


def test_the_true_model_leaves_the_noise_though_a_simulation_from_the_start_runs_away() -> None:
    recording = swung(PENDULUM)
    run = run_of(recording, PENDULUM)
    assert run.shooting is not None and run.shooting.first.size > 5
    residual = recording.measured - run.simulated(PENDULUM)
    assert np.sqrt(np.mean(residual**2)) < 1.05 * NOISE
    # a torque that is a thousandth off: from one start the pendulum ends elsewhere
    off = PENDULUM.with_values({"torque_scale": 1.001})
    alone = simulate(off, Inputs(recording.command.time, recording.command.values), recording.time)
    assert np.abs(recording.measured - alone).max() > 20.0 * NOISE
    assert np.sqrt(np.mean((recording.measured - run.simulated(off)) ** 2)) < 1.5 * NOISE


@pytest.mark.parametrize(("most", "seed"), [(0.4, 1), (0.4, 5), (0.4, 14), (0.8, 6), (0.8, 8), (1.2, 8)])
def test_no_beginning_is_off_where_a_shaft_rests_and_turns_round(most: float, seed: int) -> None:
    """Small steps of torque on a pendulum that sticks: at the true values every stretch is left at its noise."""
    recording = swung(PENDULUM, 24.0, seed, most)
    run = run_of(recording, PENDULUM)
    assert run.shooting is not None
    squares = ((recording.measured - run.simulated(PENDULUM)) / NOISE) ** 2
    counts = np.diff(np.append(run.shooting.first, squares.size))
    excess = np.add.reduceat(squares - 1.0, run.shooting.first) / np.sqrt(2.0 * counts)
    assert np.max(excess) < 4.5


def test_a_wrong_model_does_not_fit_by_other_beginnings() -> None:
    recording = swung(PENDULUM)
    run = run_of(recording, PENDULUM)
    heavy = PENDULUM.with_values({"total_inertia": 1.1 * 0.147})
    assert np.sqrt(np.mean((recording.measured - run.simulated(heavy)) ** 2)) > 5.0 * NOISE


@pytest.mark.parametrize("factor", [1.0, 0.1])
def test_the_length_of_stretches_goes_with_the_time_of_the_motion(factor: float) -> None:
    time = factor * np.arange(0.0, 20.0, 0.01)
    swing = np.sin(3.0 * time / factor) + 1e-4 * np.random.default_rng(0).standard_normal(time.size)
    # velocity over acceleration of a harmonic motion is one over its angular frequency
    assert stretch_length(time, swing, "position") == pytest.approx(2.0 * factor / 3.0, rel=0.05)
    fast = np.sin(3000.0 * time / factor)
    assert stretch_length(time, fast, "position") == pytest.approx(FEWEST * 0.01 * factor, rel=1e-6)


def test_a_part_of_a_run_begins_again_at_its_own_first_sample() -> None:
    run = run_of(swung(PENDULUM), PENDULUM)
    part = run.part(slice(100, 1100))
    assert part.shooting is not None and part.shooting.first[0] == 0
    assert np.sqrt(np.mean((part.measured - part.simulated(PENDULUM)) ** 2)) < 1.1 * NOISE


def test_a_torque_driven_pendulum_is_identified() -> None:
    true = {"torque_scale": 0.8, "total_inertia": 0.16, "coulomb_friction": 0.11, "viscous_friction.coefficient": 0.03}
    found = identify(PENDULUM, [swung(PENDULUM.with_values(true))], jobs=1)
    for name, value in true.items():
        low, high = found.fitted.ci95[name]
        assert low - 0.01 * value <= value <= high + 0.01 * value, name
    document = found.as_mapping()
    assert document["lumps"] is None and document["static_characteristic"] is None
    assert "ratio" in document["parameters"]["gravity_torque"]["fixed_by"]


def test_a_current_driven_rotor_is_identified() -> None:
    true = {"total_inertia": 4e-4, "coulomb_friction": 0.012}
    found = identify(ROTOR, [turned(ROTOR.with_values(true))], jobs=1)
    assert {name: found.fitted.values[name] for name in true} == pytest.approx(true, rel=0.01)
    assert found.findings["torque_constant"].identifiable is False


def test_a_pendulum_seen_by_its_speed_is_simulated_from_an_angle_that_suits() -> None:
    model = Model.nominal(replace(PENDULUM.actuator, quantity="speed"))
    random = np.random.default_rng(1)
    time = np.arange(0.0, 8.0, 0.004)
    torque = random.uniform(-2.5, 2.5, 21)[(time / 0.4).astype(int)]
    speed = simulate(model, Inputs(time, torque), time) + 0.005 * random.standard_normal(time.size)
    recording = Recording("speed", "speed", time, speed, Channel(time, torque), input="torque")
    data = data_of([recording], model)
    assert np.sqrt(np.mean(data.residual(model) ** 2)) < 1.1


def test_another_input_than_the_drive_asks_for_is_refused() -> None:
    recording = swung(PENDULUM, 4.0)
    with pytest.raises(InputError, match="swing holds a torque and actuator odrive is driven by a current") as refused:
        run_of(recording, ROTOR)
    assert "\n" not in str(refused.value)


def test_stretches_begin_with_the_shaft_ahead_of_a_sensor_that_lags():
    """A rotor without friction turns evenly, and its sensor shows an even motion behind it: each stretch begins so."""
    free = ROTOR.with_values({"coulomb_friction": 0.0})
    lagging = free.with_values({"sensor_lag.time_constant": 0.05})
    time = np.arange(600) * 0.002
    measured = 3.0 * (time - 0.05) + 0.2
    inputs = Inputs(np.zeros(1), np.zeros(1))
    shooting = Shooting.of(time, measured, 0.2, "position")
    assert shooting.simulated(lagging, inputs, time, measured, "position") == pytest.approx(measured, abs=1e-9)
    # from the first sample on, before any beginning is moved: the shaft is where the sensor will be a lag later
    shown = simulate(lagging, inputs, time, 0.2, 3.0)
    assert shown == pytest.approx(0.2 + 3.0 * (time - 0.05), abs=1e-9)


@pytest.mark.parametrize("lag", [1e-5, 3e-6, 1e-6])
def test_a_short_lag_goes_over_into_none_under_a_wrong_model(lag: float) -> None:
    """What a slow sensor shows is moved with the shaft: a lag far below a sample changes next to nothing."""
    recording = swung(PENDULUM)
    run = run_of(recording, PENDULUM)
    heavy = PENDULUM.with_values({"total_inertia": 1.1 * 0.147})
    none, short = (run.simulated(heavy.with_values({"sensor_lag.time_constant": each})) for each in (0.0, lag))
    assert np.abs(short - none).max() < 0.1 * NOISE


def test_uneven_samples_make_no_stretch_much_longer_than_it_should_be() -> None:
    """Where a stretch takes as many samples as it must have, the next one begins after it all the same."""
    random = np.random.default_rng(5)
    time = np.cumsum(random.uniform(0.0006, 0.0038, 4000))
    length = 20 * float(np.median(np.diff(time)))
    first = Shooting.of(time, np.sin(time), length, "position").first
    assert np.max(np.diff(time[first])) < 2.0 * length and np.min(np.diff(first)) >= FEWEST
