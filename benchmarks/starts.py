"""How often `identify` finds simulated actuators from descriptions that are far off.

Run from the project root: python benchmarks/starts.py [--starts 16]. Prints the table of docs/identification.md.
Inertia is off by up to 20 times either way, frictions and what the load weighs by up to 5 times, all at random and at
once. Found means that the fit leaves what the noise leaves.
"""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import replace

import numpy as np

from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.fit import Identified, fit
from pierburg_ros.identification.identify import free_names
from pierburg_ros.identification.reach import fitted
from pierburg_ros.inference.evidence import rms
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

INERTIA, OTHERS = math.log(20.0), math.log(5.0)
"""How far numbers of a description are off at most, as logarithms."""
OFF = {"total_inertia": INERTIA, "coulomb_friction": OTHERS, "spring_stiffness": OTHERS, "gravity_torque": OTHERS}
FOUND = 1.05
"""Error, over that of a fit from the true numbers, up to which an actuator is found."""
REST = 0.5
"""Time [s] at rest before the input begins."""
NOISE = {"pierburg": 3e-3, "ak80": 1e-3, "odrive": 1e-4, "xl330": 1e-3}
"""Noise of each sensor, in its unit."""
SECONDS = {"pierburg": 20.0, "ak80": 8.0, "odrive": 6.0, "xl330": 8.0}


def main() -> None:
    """Fit every kind of actuator from random descriptions of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=16)
    parser.add_argument("--kinds", nargs="*", default=list(NOISE))
    options = parser.parse_args()
    print("| actuator | found | seconds each |\n|---|---|---|")
    for name in options.kinds:
        model = Model.nominal(read_actuator(name))
        right, spent = 0, 0.0
        for seed in range(options.starts):
            start = Model.nominal(described(model.actuator, np.random.default_rng(seed)))
            recording = recorded(model, seed)
            begun = time.perf_counter()
            found, _ = fitted(start, [recording], free_names(start), jobs=1)
            spent += time.perf_counter() - begun
            true = fit(model, [recording], free_names(model), jobs=1)
            error, least = (left(true, each.model) for each in (found, true))
            off = {each: round(start.values[each] / model.values[each], 2) for each in OFF if each in start.values}
            print(f"  {name} {seed}: {off}: {error / least:.4g}", flush=True)
            right += error <= FOUND * least
        print(f"| {name} | {right} of {options.starts} | {spent / options.starts:.1f} |", flush=True)


def left(true: Identified, model: Model) -> float:
    """What a model leaves of the recording of a fit from the true numbers, in noises: pulled as that fit was.

    What is described wrongly would otherwise be pulled otherwise.
    """
    return rms(true.fitter.residual(model))


def described(actuator: Actuator, random: np.random.Generator) -> Actuator:
    """`actuator` as someone might describe it who knows it badly."""
    parameters = dict(actuator.parameters)
    for name, most in OFF.items():
        if name in parameters:
            factor = math.exp(random.uniform(-most, most))
            parameters[name] = replace(parameters[name], default=factor * parameters[name].default)
    factor = math.exp(random.uniform(-OTHERS, OTHERS))
    effects = {effect: {own: factor * x for own, x in values.items()} for effect, values in actuator.effects.items()}
    return replace(actuator, parameters=parameters, effects=effects)


def recorded(model: Model, seed: int) -> Recording:
    """A simulated recording with noise: the valve's rich recipe, or an input that wanders."""
    name, actuator, random = model.actuator.name, model.actuator, np.random.default_rng(seed)
    times = np.arange(round(250.0 * SECONDS[name])) / 250.0
    if actuator.load == "spring":
        command = duty_sequence("rich", model, times, seed)
    else:
        knots = np.linspace(0.0, times[-1], round(2.5 * SECONDS[name]))
        level, scale = {"ak80": (0.0, 2.0), "odrive": (1.2, 0.4), "xl330": (0.0, 0.5)}[name]
        command = level + scale * np.interp(times, knots, random.standard_normal(knots.size))
        command = np.clip(command, -1.0, 1.0) if actuator.input == "duty" else command
    command = np.where(times < REST, 0.0, command)
    measured = simulate(model, Inputs(times, command), times)
    measured = measured + NOISE[name] * random.standard_normal(times.size)
    return Recording("start", actuator.quantity, times, measured, Channel(times, command), input=actuator.input)


if __name__ == "__main__":
    main()
