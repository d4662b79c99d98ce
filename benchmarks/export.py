"""The export to MuJoCo beside our simulator, effect by effect.

`python benchmarks/export.py [RUNS]` prints the table of docs/developers/measurements.md.
"""

import runpy
import sys
from pathlib import Path

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_runs
from pierburg_ros.control import Settings
from pierburg_ros.export import export
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.decode import decoded

RUN = runpy.run_path(str(Path(__file__).parents[1] / "examples" / "run_in_mujoco.py"))["run"]
INTERVAL, DURATION = 0.002, 20.0
CASES = {
    "none": {},
    "none, in closed loop": {},
    "viscous friction": {"viscous_friction.coefficient": 0.03},
    "static friction": {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1},
    "static friction, against our bristles": {
        "static_friction.breakaway_torque": 0.27,
        "static_friction.stribeck_velocity": 0.1,
        "presliding.stiffness": 400.0,
    },
    "presliding": {"presliding.stiffness": 40.0, "presliding.damping": 0.03},
    "cogging torque": {"cogging_torque.amplitude": 0.03, "cogging_torque.periods_per_motor_revolution": 6.0},
    "nonlinear spring, cubic": {"nonlinear_spring.cubic_stiffness": 0.05},
    "stop compliance": {"stop_compliance.stiffness": 30.0, "stop_compliance.damping": 0.01},
    "thermal resistance": {"thermal_resistance.thermal_resistance": 20.0, "thermal_resistance.heat_capacity": 1.0},
    "armature inductance": {"armature_inductance.inductance": 0.002},
    "input delay": {"input_delay.delay": 0.008},
}
NOMINAL = Model.nominal(read_actuator("pierburg"))
TIME = np.arange(0.0, DURATION, INTERVAL)


def duty(name: str, seed: int) -> np.ndarray:
    """A duty at each sample: random steps, or what the controller of the package made for random setpoints."""
    random = np.random.default_rng(seed)
    if "closed loop" in name:
        setpoints = random.uniform(0.1, 1.45, 10)[(TIME / 2.0).astype(int)]
        return simulate_runs(NOMINAL, Settings(), setpoints[np.newaxis], noise=0.003, seed=seed).duty[0]
    values = random.uniform(-0.1, 0.5, 50)
    values[0] = 0.0
    return values[(TIME / 0.4 + 1e-9).astype(int)]


def errors(name: str, runs: int) -> tuple[float, float, float]:
    """Root mean square and largest difference of the angles [rad] over all runs, and RMS of the effect itself."""
    model, differences, marks = NOMINAL.with_values(CASES[name]), [], []
    text = export(model, "mujoco").text
    for seed in range(runs):
        inputs = Inputs(TIME, duty(name, seed))
        ours = decoded(NOMINAL, simulate(model, inputs, TIME))
        marks.append(ours - decoded(NOMINAL, simulate(NOMINAL, inputs, TIME)))
        differences.append(RUN(text, inputs.command, INTERVAL) - ours)
    difference = np.concatenate(differences)
    return rms(difference), float(np.max(np.abs(difference))), rms(np.concatenate(marks))


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    print(f"n = {count} runs of {DURATION:g} s at {1 / INTERVAL:g} Hz each; mrad.\n")
    print("| effect | it moves the shaft by, RMS | difference, RMS | largest |\n|---|---|---|---|")
    for case in CASES:
        root, largest, own = errors(case, count)
        print(f"| {case} | {1e3 * own:.1f} | {1e3 * root:.2f} | {1e3 * largest:.1f} |", flush=True)
