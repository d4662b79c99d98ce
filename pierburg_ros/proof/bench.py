"""Records a trial: the concealed textbook valve under open-loop duty or under the PIFLC."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.control import Controller, Settings
from pierburg_ros.proof.dirt.disturbance import Disturbance
from pierburg_ros.proof.dirt.kinds import DISTURBING, SPOILING
from pierburg_ros.proof.dirt.log import Log, Messages
from pierburg_ros.proof.excitation import duty_sequence, setpoint_sequence
from pierburg_ros.proof.formulation import TextbookPlant
from pierburg_ros.proof.trial import Trial
from pierburg_ros.recording import Channel, write_simulated
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.write import write_recording


@dataclass(frozen=True)
class Recorded:
    """One run: time [s], duty [1], measured and noise-free Hall voltage [V], setpoints [rad] where given.

    `log` is what was logged of it where that differs.
    """

    time: Signal
    duty: Signal
    measured: Signal
    ideal: Signal
    setpoints: Signal | None
    log: Log | None = None

    def write(self, path: Path) -> None:
        """Write what a bench would have logged as MCAP: setpoints only where they change."""
        if self.log is not None:
            write_log(path, self.log)
            return
        if self.setpoints is None:
            write_simulated(path, self.time, self.duty, self.measured)
            return
        changes = np.flatnonzero(np.diff(self.setpoints, prepend=np.nan) != 0.0)
        given = Channel(self.time[changes], self.setpoints[changes])
        write_simulated(path, self.time, self.duty, self.measured, setpoints=given)


def write_log(path: Path, log: Log) -> None:
    """Write a log as MCAP with the numbers of its messages."""
    topics = {"/hall_voltage": log.hall, "/duty": log.duty}
    signals = {topic: (cdr.FLOAT64, each.time, each.values) for topic, each in topics.items()}
    write_recording(path, signals, numbers={topic: each.number for topic, each in topics.items()})


def sampled(duration: float, rate: float) -> Signal:
    """Sample times from 0 [s]."""
    return np.arange(round(duration * rate)) / rate


def converted(voltage: float, trial: Trial) -> float:
    """What the converter of the valve, or else of the logger, makes of a Hall voltage [V]."""
    step = trial.effects.get("sensor_quantization.step", 0.0) or trial.converter_step
    return step * round(voltage / step) if step else voltage


def run(
    trial: Trial,
    time: Signal,
    noise: Signal,
    answer: Callable[[int, float], float],
    disturbance: Disturbance | None = None,
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
        advance(plant, duty[tick], tick, trial, disturbance or Disturbance())
    return duty, measured, ideal


def advance(plant: TextbookPlant, duty: float, tick: int, trial: Trial, acting: Disturbance) -> None:
    """One tick of the plant under what acts beside the duty."""
    supply = None if acting.supply is None else float(acting.supply[tick])
    enabled = acting.enabled is None or bool(acting.enabled[tick])
    if acting.torque is not None:
        plant.values = {**plant.values, "external_load.torque": float(acting.torque[tick]), "external_load.end": 1e9}
    plant.advance(duty, 1.0 / trial.rate, supply, enabled)


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
    disturbance = None if holdout or trial.dirt not in DISTURBING else DISTURBING[trial.dirt](time, random)
    recorded = Recorded(time, *run(trial, time, noise, lambda k, _: float(planned[k + 1]), disturbance), None)
    return recorded if holdout else spoiled(recorded, trial.dirt, random)


def spoiled(recorded: Recorded, dirt: str, random: np.random.Generator) -> Recorded:
    """The run with the log that some dirt makes of it."""
    if dirt not in SPOILING:
        return recorded
    clean = Log(*(Messages.of(recorded.time, values) for values in (recorded.measured, recorded.duty)))
    return replace(recorded, log=SPOILING[dirt](clean, random))
