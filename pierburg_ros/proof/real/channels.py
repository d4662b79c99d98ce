"""Between a recording and the channels that an effect may change, and from there to a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.inference.evidence import grid
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.recording import Channel, Recording, write_recording
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.noise import noise_of
from pierburg_ros.recording.write import MEASURED
from pierburg_ros.recording.write import Signal as Written


def with_effect(recording: Recording, effect: str, values: dict[str, float], model: Model) -> Recording:
    """`recording` of the machine that `model` describes with an effect of these `values`; CannotPutIn where not exact.

    What the sensor's effects make of the samples has the noise and the steps of the recording, which come after them; a
    coarser converter takes the place of its own.
    """
    declared = EFFECT[effect]
    assert declared.put_in is not None
    before = channels_of(recording, model)
    after = declared.put_in(before, values)
    measured = after.measured.values
    if after.measured is not before.measured and declared.rounds is None:
        measured = logged(recording.time, measured, recording.measured)
    supply = after.supply_voltage
    return replace(
        recording,
        measured=measured,
        command=Channel(after.command.time, after.command.values),
        supply_voltage=None if supply is None else Channel(supply.time, supply.values),
    )


def channels_of(recording: Recording, model: Model) -> Channels:
    """What an effect may change of a recording, with the sensor of `model`, taken to be straight."""
    supply = recording.supply_voltage
    zero, per_radian = model.values.get("sensor_offset", 0.0), 1.0 / angle_per_unit(model)
    if recording.quantity == "hall_voltage":
        zero = model.values["hall_voltage_closed"]
    return Channels(
        Series(recording.time, recording.measured),
        Series(recording.command.time, recording.command.values),
        None if supply is None else Series(supply.time, supply.values),
        zero,
        per_radian,
        model.actuator.sensor_span,
    )


def logged(time: Signal, values: Signal, original: Signal) -> Signal:
    """`values` of a changed sensor as the recording's own converter gives them, shape (samples,).

    Noise and steps come after the sensor. White noise that a lag or a play has taken from the `original` is added anew,
    always the same; and all is rounded to the grid on which the original lies, if it lies on one.
    """
    step = grid(original)
    own, left = (max(noise_of(time, each) ** 2 - step**2 / 12.0, 0.0) for each in (original, values))
    noise = np.sqrt(max(own - left, 0.0)) * np.random.default_rng(values.size).standard_normal(values.size)
    noisy: Signal = values + noise
    return noisy if step == 0.0 else np.asarray(original[0] + step * np.rint((noisy - original[0]) / step))


def write(path: Path, recording: Recording) -> None:
    """Write a recording to MCAP under the topics that are found unnamed."""
    topic, kind = MEASURED[recording.quantity]
    signals: dict[str, Written] = {
        topic: (kind, recording.time, recording.measured),
        f"/{recording.input}": (cdr.FLOAT64, recording.command.time, recording.command.values),
    }
    others = {
        "/supply_voltage": (cdr.FLOAT64, recording.supply_voltage),
        "/temperature": (cdr.FLOAT64, recording.temperature),
        "/enabled": (cdr.BOOL, recording.enabled),
        "/setpoints": (cdr.FLOAT64, recording.setpoints),
    }
    signals |= {name: (of, each.time, each.values) for name, (of, each) in others.items() if each is not None}
    write_recording(path, signals)
