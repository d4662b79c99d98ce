"""Which numbers of an actuator recordings could determine, by a simulated standard excitation of its description."""

from __future__ import annotations

import numpy as np

from pierburg_ros.identification.fit import fit
from pierburg_ros.identification.identifiability import Finding, identifiability
from pierburg_ros.identification.identify import free_names
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.recording import Channel, Recording

BENCH_SAMPLES = 6000
"""Number of samples of the simulated bench. Work: a fit of them takes seconds."""
LEVELS = 60
"""Number of levels of the input. Chosen: 100 samples each on average, from a fraction of a movement to several."""
HOLDS = (0.5, 1.5, 6.0)
"""Times for which levels are held in turn, in units of the time in which the actuator crosses its travel. Chosen: some
are too short to settle, and some are long enough."""
STRENGTH = 0.6
"""Largest level, as a share of the actuator's own large input. Chosen: full input holds the shaft at a stop."""
RESOLUTION = 1e-3
"""Noise of the simulated sensor, as a share of its own large reading. Chosen: that of a 10 bit converter."""


def told(model: Model, seed: int = 0) -> dict[str, Finding]:
    """The finding for each number of `model` from a standard excitation; InputError where that cannot be simulated."""
    recording = bench(model, seed)
    fitted = fit(model, [recording], free_names(model), jobs=1)
    return identifiability(fitted, [recording])


def bench(model: Model, seed: int = 0) -> Recording:
    """A simulated recording: random levels of the input, short and long, after a moment of rest."""
    random = np.random.default_rng(seed)
    scales, actuator = model.scales, model.actuator
    largest = STRENGTH * {"duty": 1.0, "current": scales.current, "torque": scales.torque}[actuator.input]
    lengths = scales.time * np.resize(HOLDS, LEVELS)
    changes = np.concatenate([[0.0], scales.time + np.cumsum(lengths)])
    command = Channel(changes[:-1], np.concatenate([[0.0], largest * random.uniform(-1.0, 1.0, LEVELS - 1)]))
    time = np.linspace(0.0, changes[-1], BENCH_SAMPLES)
    clean = simulate(model, Inputs(command.time, command.values), time)
    refuse_unsimulated(model, clean, time)
    measured = clean + RESOLUTION * scales.reading * random.standard_normal(time.size)
    return Recording(f"a bench of {actuator.name}", actuator.quantity, time, measured, command, input=actuator.input)
