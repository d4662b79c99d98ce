"""Records a trial: the concealed textbook valve under open-loop duty or under the PIFLC."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.control import Controller, Settings
from pierburg_ros.proof.excitation import duty_sequence, setpoint_sequence
from pierburg_ros.proof.formulation import TextbookPlant
from pierburg_ros.proof.trial import Trial
from pierburg_ros.recording import Channel, write_simulated


@dataclass(frozen=True)
class Recorded:
    """One run: time [s], duty [1], measured and noise-free Hall voltage [V], setpoints [rad] where given."""

    time: Signal
    duty: Signal
    measured: Signal
    ideal: Signal
    setpoints: Signal | None

    def write(self, path: Path) -> None:
        """Write what a bench would have logged as MCAP: setpoints only where they change."""
        if self.setpoints is None:
            write_simulated(path, self.time, self.duty, self.measured)
            return
        changes = np.flatnonzero(np.diff(self.setpoints, prepend=np.nan) != 0.0)
        given = Channel(self.time[changes], self.setpoints[changes])
        write_simulated(path, self.time, self.duty, self.measured, setpoints=given)


def sampled(duration: float, rate: float) -> Signal:
    """Sample times from 0 [s]."""
    return np.arange(round(duration * rate)) / rate


def converted(voltage: float, trial: Trial) -> float:
    """What the converter of the valve, or else of the logger, makes of a Hall voltage [V]."""
    step = trial.effects.get("sensor_quantization.step", 0.0) or trial.converter_step
    return step * round(voltage / step) if step else voltage


def run(
    trial: Trial, time: Signal, noise: Signal, answer: Callable[[int, float], float]
) -> tuple[Signal, Signal, Signal]:
    """Duty, measured and noise-free Hall voltage; `answer(tick, measured)` is the duty of the next tick."""
    plant = TextbookPlant({**trial.values, "sensor_quantization.step": 0.0})
    duty, measured, ideal = np.zeros(time.size), np.zeros(time.size), np.zeros(time.size)
    given = 0.0
    for tick in range(time.size):
        if trial.change is not None and time[tick] >= trial.change.time:
            plant.values = {**plant.values, trial.change.parameter: trial.change.after}
            trial = replace(trial, change=None)
        ideal[tick] = plant.measure()
        measured[tick] = converted(ideal[tick] + noise[tick], trial)
        duty[tick] = given
        given = answer(tick, measured[tick])
        plant.advance(duty[tick], 1.0 / trial.rate)
    return duty, measured, ideal


def record(trial: Trial, holdout: bool = False) -> Recorded:
    """The trial's recording, or its unseen one: other excitation and noise, after the change if any."""
    if holdout and trial.change is not None:
        trial = replace(trial, change=replace(trial.change, time=0.0))
    time = sampled(trial.holdout_duration if holdout else trial.duration, trial.rate)
    random = np.random.default_rng([trial.seed, int(holdout)])
    noise = trial.noise * random.standard_normal(time.size)
    if trial.closed_loop:
        setpoints = setpoint_sequence(time, random, holdout)
        controller = Controller(Settings().with_values(trial.controller))
        period = 1.0 / trial.rate
        signals = run(trial, time, noise, lambda k, hall: controller.step(setpoints[k], hall, period))
        return Recorded(time, *signals, setpoints)
    planned = np.append(duty_sequence(time, random, holdout), 0.0)
    return Recorded(time, *run(trial, time, noise, lambda k, _: float(planned[k + 1])), None)
