"""What a model would have measured under the inputs of a recording."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.inference.data import FIRST, refuse_others, run_of, unknown_spans
from pierburg_ros.inference.fit import beginning, inertia_time, pull_of
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.plant.following import Pull, follow
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.recording import Recording


def parts_of(recording: Recording, actuator: Actuator) -> list[Recording]:
    """The parts of `recording` under a known input, not just after an unknown one; InputError without any.

    A simulation begins anew in each, where its first samples show the shaft.
    """
    if recording.time.size < 2 * FIRST:
        raise InputError(
            f"{recording.name} is too short ({recording.time.size} samples), expected at least {2 * FIRST}."
            " Record longer."
        )
    known, part = np.ones(recording.time.size, dtype=bool), np.zeros(recording.time.size, dtype=np.int64)
    for start, end in unknown_spans(recording, actuator):
        known &= (recording.time < start) | (recording.time > end + actuator.scales.time)
        part += recording.time > end
    several = [known & (part == number) for number in range(int(part.max(initial=0)) + 1)]
    found = [
        replace(recording, time=recording.time[which], measured=recording.measured[which])
        for which in several
        if np.count_nonzero(which) >= 2 * FIRST
    ]
    if not found:
        raise InputError(
            f"{recording.name} has no {2 * FIRST} samples in a row under a known {recording.input} (messages are"
            " missing). Record again with fewer processes beside."
        )
    return found


def resimulated(model: Model, recording: Recording) -> tuple[Recording, Signal]:
    """The samples of `recording` under a known input, and their simulation by `model`, shape (samples,).

    InputError where none can be simulated.
    """
    refuse_others(recording, model.actuator)
    parts = parts_of(recording, model.actuator)
    simulated = np.concatenate([_simulated(model, part) for part in parts])
    time, measured = (np.concatenate([getattr(part, name) for part in parts]) for name in ("time", "measured"))
    refuse_unsimulated(model, simulated, time)
    return replace(recording, time=time, measured=measured), simulated


def _simulated(model: Model, recording: Recording) -> Signal:
    """The simulation of a recording whose input is known, in its unit, shape (samples,)."""
    nominal = Model.nominal(model.actuator)
    run = run_of(recording, nominal, 0, np.zeros(recording.time.size, dtype=np.int64))
    period = float(np.median(np.diff(run.time)))
    inertial = inertia_time(nominal) > period and run.quantity != "speed"
    pull = Pull.every(run.time, pull_of(model.actuator, period), inertial)
    found = follow(model, run.inputs, run.time, run.measured, beginning(run, model), pull)
    turned = recording.quantity == "position" and run.quantity == "hall_voltage"
    return decoded(nominal, found) if turned else found
