"""Runs an exported model in MuJoCo under a duty, `python run_in_mujoco.py MODEL.xml DUTY.csv OUT.csv`.

    pierburg export examples/worn_valve.yaml --to mujoco --output valve.xml
    python examples/run_in_mujoco.py valve.xml examples/bench.csv mujoco.csv
    pierburg diagnose examples/bench.csv --simulation mujoco.csv --output results/against_mujoco

DUTY.csv has the columns time [s] and duty [1], at an even rate; OUT.csv gets time, duty and position [rad], which every
command of pierburg reads. Needs MuJoCo: pip install 'pierburg_ros[mujoco]'.
"""

import csv
import sys
from pathlib import Path

import mujoco
import numpy as np


def run(model: str, duty: np.ndarray, interval: float) -> np.ndarray:
    """Angle [rad] at each sample, before its duty acts, shape (samples,); `interval` [s] between samples."""
    compiled = mujoco.MjModel.from_xml_string(model)
    data = mujoco.MjData(compiled)
    supply = compiled.actuator_ctrlrange[0, 1]
    compiled.opt.timestep = interval / np.ceil(interval / compiled.opt.timestep - 1e-9)
    steps = round(interval / compiled.opt.timestep)
    angle = np.empty(duty.size)
    for sample, share in enumerate(duty):
        angle[sample], data.ctrl[0] = data.qpos[0], share * supply
        mujoco.mj_step(compiled, data, steps)
    return angle


def main(model: str, duty_file: str, output: str) -> None:
    """Read the duty, run, write the recording."""
    with open(duty_file, newline="", encoding="utf-8") as file:
        rows = [(float(row["time"]), float(row["duty"])) for row in csv.DictReader(file)]
    time, duty = np.array(rows).T
    angle = run(Path(model).read_text(encoding="utf-8"), duty, float(np.median(np.diff(time))))
    with open(output, "w", newline="", encoding="utf-8") as file:
        written = csv.writer(file)
        written.writerow(["time", "duty", "position"])
        written.writerows(zip(time, duty, angle, strict=True))


if __name__ == "__main__":
    main(*sys.argv[1:])
