"""A servo on a pendulum, simulated by other means than the package's, and what a diagnosis makes of each recording.

    python benchmarks/servo.py [--output FOLDER] [--budget EFFORT] [--only CASE ...]

prints a table. The machine moves by explicit steps of 20 us under a proportional loop at 200 Hz
that reads an encoder of 4096 steps. Its description is the shipped `xl330`, off by 10 to 30 % in three numbers. What
the output folder holds already is not diagnosed again; the recordings there are CSV files for `pierburg diagnose`.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit

import pierburg_ros as pr
from pierburg_ros.arrays import Signal

PERIOD, LENGTH = 0.005, 30.0
"""Sample period and length of a recording [s]."""
STEP = 2e-5
"""Step of the simulation [s]."""
ENCODER = 2.0 * np.pi / 4096
"""Step of the encoder [rad]."""
COPPER = 0.0039
"""Change of the resistance with temperature [1/K]."""


class Servo(NamedTuple):
    """The machine in SI units at the output shaft; a strength of 0 is an effect that does not act."""

    resistance: float = 2.8 * 1.15
    torque_constant: float = 0.37
    inertia: float = 0.0075 * 1.1
    weight: float = 0.481
    coulomb_friction: float = 0.03 * 1.3
    viscous_friction: float = 0.01
    supply: float = 7.4
    gain: float = 2.0
    delay: float = 0.0
    lag: float = 0.0
    sag: float = 0.0
    breakaway_excess: float = 0.0
    stribeck_velocity: float = 0.2
    friction_by_weight: float = 0.0
    cogging: float = 0.0
    cogging_periods: float = 7.0
    thermal_resistance: float = 0.0
    heat_capacity: float = 1.0
    relaxing_stiffness: float = 0.0
    relaxation_time: float = 0.5
    ageing: float = 0.0


REMAINDER = Servo(relaxing_stiffness=0.04, relaxation_time=0.8, ageing=0.004)
"""A stiffness that relaxes, and friction that grows with the logarithm of the time at rest: no effect has these."""
CASES = {
    "no effect": Servo(),
    "input_delay": Servo(delay=0.012),
    "static_friction": Servo(breakaway_excess=0.03, stribeck_velocity=0.3),
    "friction by weight": Servo(friction_by_weight=0.15),
    "cogging_torque": Servo(cogging=0.04),
    "thermal_resistance": Servo(thermal_resistance=20.0, heat_capacity=0.4),
    "supply_sag": Servo(sag=0.6),
    "sensor_lag": Servo(lag=0.015),
    "remainder": REMAINDER,
    "input_delay beside it": REMAINDER._replace(delay=0.012),
    "friction by weight beside it": REMAINDER._replace(friction_by_weight=0.2),
    "static_friction beside it": REMAINDER._replace(breakaway_excess=0.03, stribeck_velocity=0.3),
}
"""What is hidden, by the name of the catalogue's effect where it has one. Its place in this order is a case's seed."""


@njit(cache=False)
def simulate(setpoints: Signal, servo: Servo) -> tuple[Signal, Signal]:
    """Measured angle [rad] and duty [1] at each setpoint [rad]; friction is set-valued and solved in each step."""
    position, duty = np.zeros(setpoints.size), np.zeros(setpoints.size)
    waiting = np.zeros(round(servo.delay / STEP) + 1)
    angle = velocity = warmth = lagging = stretch = rest = 0.0
    step = 0
    for sample in range(setpoints.size):
        read = lagging if servo.lag > 0.0 else angle
        position[sample] = round(read / ENCODER) * ENCODER
        duty[sample] = min(1.0, max(-1.0, servo.gain * (setpoints[sample] - position[sample])))
        for _ in range(round(PERIOD / STEP)):
            waiting[step % waiting.size] = duty[sample]
            step += 1
            acting = waiting[step % waiting.size]
            resistance = servo.resistance * (1.0 + COPPER * warmth)
            back = servo.torque_constant * velocity
            current = (acting * servo.supply - back) / (resistance + servo.sag * acting * acting)
            if servo.thermal_resistance > 0.0:
                heat = resistance * current * current - warmth / servo.thermal_resistance
                warmth += STEP * heat / servo.heat_capacity
            pull = servo.weight * np.sin(angle)
            torque = servo.torque_constant * current - pull - servo.viscous_friction * velocity
            torque -= servo.cogging * np.sin(servo.cogging_periods * angle)
            stretch += STEP * (velocity - stretch / servo.relaxation_time)
            torque -= servo.relaxing_stiffness * stretch
            rest = rest + STEP if abs(velocity) < 1e-9 else max(0.0, rest - 20.0 * STEP)
            friction = servo.coulomb_friction + servo.friction_by_weight * abs(pull)
            friction += servo.breakaway_excess * np.exp(-((velocity / servo.stribeck_velocity) ** 2))
            friction += servo.ageing * np.log1p(rest / 0.05)
            free = velocity + STEP * torque / servo.inertia
            held = STEP * friction / servo.inertia
            velocity = 0.0 if abs(free) <= held else free - np.sign(free) * held
            angle += STEP * velocity
            if servo.lag > 0.0:
                lagging += STEP * (angle - lagging) / servo.lag
    return position, duty


def setpoints_of(seed: int) -> Signal:
    """Half a recording of four sines, then jumps besides; half a second of 0 to begin with [rad]."""
    random, count = np.random.default_rng(seed), round(LENGTH / PERIOD)
    times, setpoints = np.arange(count) * PERIOD, np.zeros(count)
    for frequency in random.uniform(0.1, 1.2, 4):
        setpoints += random.uniform(0.2, 0.7) * np.sin(2 * np.pi * frequency * times + random.uniform(0, 6))
    begin = 0
    while begin < count:
        length, level = int(random.uniform(0.5, 2.0) / PERIOD), random.uniform(-1.8, 1.8)
        if begin > count // 2:
            setpoints[begin : begin + length] = level
        begin += length
    setpoints[: int(0.5 / PERIOD)] = 0.0
    return setpoints


def record(path: Path, servo: Servo, seed: int) -> None:
    """Write a recording of the machine as a CSV."""
    setpoints = setpoints_of(seed)
    position, duty = simulate(setpoints, servo)
    rows = zip(np.arange(setpoints.size) * PERIOD, duty, position, setpoints, strict=True)
    lines = [f"{at:.4f},{d:.6f},{angle:.6f},{servo.supply},{aim:.5f}\n" for at, d, angle, aim in rows]
    path.write_text("time,duty,position,supply_voltage,setpoints\n" + "".join(lines), encoding="utf-8")


def row(case: str, document: dict[str, Any], seconds: float, unseen: float) -> str:
    """A row of the table: what is hidden, what was found, the error on another recording, the time."""
    named = "; ".join(
        f"{each['id']} {numbers(each['parameters'])} ({each['confidence']:.2f})" for each in document["effects"]
    )
    return f"| {case} | {document['verdict']} | {named or 'nothing'} | {unseen:.2g} | {seconds:.0f} |"


def numbers(parameters: dict[str, Any]) -> str:
    return ", ".join(f"{name} {each['value']:.4g}" for name, each in parameters.items())


def main() -> None:
    """Diagnose a recording of each case, and print what was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("results/servo"))
    parser.add_argument("--budget", default="1")
    parser.add_argument("--only", nargs="+", choices=CASES, default=list(CASES), metavar="CASE")
    given = parser.parse_args()
    print("| hidden | verdict | named | RMSE on another recording [rad] | s |")
    print("|---|---|---|---|---|")
    for seed, (case, servo) in enumerate(CASES.items()):
        if case not in given.only:
            continue
        folder = given.output / case.replace(" ", "_")
        if not (folder / "took.json").exists():
            folder.mkdir(parents=True, exist_ok=True)
            record(folder / "recording.csv", servo, 100 + seed)
            record(folder / "another.csv", servo, 200 + seed)
            began = time.perf_counter()
            pr.diagnose(folder / "recording.csv", actuator="xl330", budget=given.budget).save(folder / "diagnosis")
            (folder / "took.json").write_text(json.dumps(time.perf_counter() - began))
        found = folder / "diagnosis"
        document = json.loads((found / "diagnosis.json").read_text(encoding="utf-8"))
        unseen = pr.compare(folder / "another.csv", pr.Model.read(found / "model.yaml")).rmse
        print(row(case, document, json.loads((folder / "took.json").read_text()), unseen), flush=True)


if __name__ == "__main__":
    main()
