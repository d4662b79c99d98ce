"""What a model would have measured under the inputs of a recording."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.errors import InputError
from pierburg_ros.inference.data import FIRST, Run, run_of
from pierburg_ros.inference.fit import beginning, inertia_time, rungs
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit, decoded
from pierburg_ros.plant.following import Pull, follow
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.recording import Recording


def forgets(actuator: Actuator) -> bool:
    """Whether an actuator forgets its initial state: a spring or a closed bridge brings it back."""
    return actuator.load == "spring" or actuator.drive == "voltage"


def longest_pull(actuator: Actuator, time: Signal) -> float:
    """Time constant [s] with which a replay is pulled to samples at each `time` [s]; infinite where none is needed.

    A pendulum or a free rotor driven by a current or a torque forgets nothing. Its simulation drifts from any recording
    for ever, so it is pulled as weakly as a fit is at its end.
    """
    return math.inf if forgets(actuator) else rungs(actuator, float(np.median(np.diff(time))))[-1]


def with_known_input(recording: Recording, actuator: Actuator) -> Recording:
    """The samples of `recording` under a known input, and not just after an unknown one; InputError without any."""
    known = np.ones(recording.time.size, dtype=bool)
    for start, end in recording.unknown_input:
        known &= (recording.time < start) | (recording.time > end + actuator.scales.time)
    if np.count_nonzero(known) < 2 * FIRST:
        raise InputError(
            f"{recording.name} has fewer than {2 * FIRST} samples under a known {recording.input} (messages are"
            " missing). Record again with fewer processes beside."
        )
    return replace(recording, time=recording.time[known], measured=recording.measured[known])


def resimulated(model: Model, recording: Recording) -> tuple[Recording, Signal]:
    """The samples of `recording` under a known input, and their simulation by `model`, shape (samples,).

    After each stretch of unknown input the simulation begins again where the shaft is then. InputError where none can
    be simulated.
    """
    nominal = Model.nominal(model.actuator)
    kept = with_known_input(recording, model.actuator)
    run = run_of(kept, nominal, 0, np.zeros(kept.time.size, dtype=np.int64))
    simulated = simulated_run(model, run, longest_pull(model.actuator, run.time), after_unknown(kept))
    refuse_unsimulated(model, simulated, run.time)
    return kept, in_unit_of(kept, nominal, simulated)


def in_unit_of(recording: Recording, nominal: Model, values: Signal) -> Signal:
    """`values` of the actuator's sensor in the unit of a `recording`, which may hold the angle in its place."""
    turned = recording.quantity == "position" and nominal.actuator.quantity == "hall_voltage"
    return decoded(nominal, values) if turned else values


def after_unknown(recording: Recording) -> Flags:
    """Which samples are the first after a stretch of unknown input, shape (samples,)."""
    first = np.zeros(recording.time.size, dtype=bool)
    for _, end in recording.unknown_input:
        place = int(np.searchsorted(recording.time, end))
        if 0 < place < recording.time.size:
            first[place] = True
    return first


def simulated_run(model: Model, run: Run, constant: float, again: Flags) -> Signal:
    """The simulation of a run, pulled with a time `constant` [s], shape (samples,).

    It begins `again` at some samples, as much as the next ones show.
    """
    nominal = Model.nominal(model.actuator)
    own = inertia_time(nominal) > float(np.median(np.diff(run.time))) and run.quantity != "speed"
    pull, start = Pull.every(run.time, constant, own), beginning(run, model)
    if math.isinf(constant) and again.any():
        seen = np.flatnonzero(again)
        last = np.minimum(seen + FIRST - 1, run.time.size - 1)
        pull = Pull(last, seen, np.ones(last.size), np.zeros(last.size))
    return follow(model, run.inputs, run.time, run.measured, start, pull, angle_per_unit(nominal))
