"""Recordings for the tests of the diagnosis, made by the simulator, so that only its own logic is at stake."""

from dataclasses import replace

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_runs
from pierburg_ros.control import Settings
from pierburg_ros.inference.data import Data, data_of
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.following import Pull, follow
from pierburg_ros.recording import Channel, Recording

PIERBURG = read_actuator("pierburg")
NOMINAL = Model.nominal(PIERBURG)
NOISE = 0.003
MODEST = Settings().with_values(
    {
        "pi_output_support": 1.2,
        "integral_gain": 0.8,
        "positive": 0.5,
        "negative": -0.5,
        "duty_minimum": -0.35,
        "duty_maximum": 0.65,
    }
)
"""A controller with less duty than the package's own, so that the shaft rests between setpoints."""


def data_on(*recordings: Recording) -> Data:
    """The recordings of the nominal valve as a diagnosis sees them, split into what trains, validates and tests."""
    return data_of(recordings, NOMINAL)


def recording(
    changes: dict[str, float], duration: float = 24.0, seed: int = 0, duties: tuple[float, float] = (-0.05, 0.36)
) -> Recording:
    """Random steps between two duties at 500 Hz through the nominal valve with `changes`, 3 mV of noise."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 0.002)
    steps = random.uniform(*duties, int(duration / 0.6) + 1)
    duty = steps[(time / 0.6).astype(int)]
    duty[time < 0.3] = 0.0
    return recording_under(duty, time, changes, random)


def recording_in_closed_loop(changes: dict[str, float], seed: int = 0, duration: float = 24.0) -> Recording:
    """At 500 Hz under the PIFLC at modest duty, a new setpoint every 2 s; the valve as above."""
    random = np.random.default_rng(seed)
    time = np.arange(0.0, duration, 0.002)
    setpoints = random.uniform(0.15, 1.4, int(duration / 2.0))[(time / 2.0).astype(int)]
    run = simulate_runs(NOMINAL.with_values(changes), MODEST, setpoints[np.newaxis], noise=NOISE, seed=seed)
    return Recording("test.mcap", "hall_voltage", time, run.hall_voltage[0], Channel(time, run.duty[0]))


def recording_under(
    duty: np.ndarray, time: np.ndarray, changes: dict[str, float], random: np.random.Generator
) -> Recording:
    """The nominal valve with `changes` under a duty, shape (samples,), 3 mV of noise."""
    hall = simulate(NOMINAL.with_values(changes), Inputs(time, duty), time)
    return Recording(
        "test.mcap",
        "hall_voltage",
        time,
        hall + NOISE * random.standard_normal(time.size),
        Channel(time, duty),
    )


def disturbed(changes: dict[str, float], seed: int) -> Recording:
    """A recording of the valve with `changes` beside a slow wave of ten times the noise that no effect makes."""
    clean = recording(changes, duration=16.0, seed=seed)
    random = np.random.default_rng(seed + 100)
    knots = np.linspace(clean.time[0], clean.time[-1], 12)
    wave = np.interp(clean.time, knots, random.normal(0.0, 10.0 * NOISE, knots.size))
    wave[clean.time < 0.5] = 0.0
    return replace(clean, measured=clean.measured + wave)


def changing(model: Model, after: Model, when: float, inputs: Inputs, time: np.ndarray) -> np.ndarray:
    """The simulation of a model that another one takes over from `when` [s], pulled by nothing."""
    nothing = np.zeros(time.size)
    return follow(model, inputs, time, nothing, np.zeros(4), Pull.every(time, np.inf, False), after, when)
