"""Draws the picture that README and site open with, from the recording of the story: python docs/images/first.py.

Above, ten seconds of the recording, of the valve as described, and of the corrected model. Below, the friction that was
missing over the velocity: the law, what the recording says of it in motion, and the torque at which the shaft broke
loose.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pierburg_ros as pr
from pierburg_ros.pages.over_time import COLOURS

ROOT = Path(__file__).parents[2]
SHOWN = (5.0, 15.0)
"""What is drawn of the recording [s]."""
NAMES = {"measured": "measured", "nominal": "as described", "final": "corrected"}
SLOW = 1.5
"""Largest velocity that is drawn [rad/s]: the friction differs near standstill."""
REST = 25
"""Samples without motion before the shaft breaks loose: 0.1 s."""
LOOSE = 0.01
"""Angle [rad] by which it has broken loose: eight times the sensor's noise."""


def breakaways(diagnosis: pr.Diagnosis) -> np.ndarray:
    """Friction [N.m] at each end of a standstill off the stops: the motor's torque less the spring's, signed."""
    view, value = diagnosis.found.exhibits.views[0], diagnosis.found.model.values
    drive = value["gear_ratio"] * value["torque_constant"] * value["supply_voltage"] / value["armature_resistance"]
    free = drive * view.command - value["spring_preload"] - value["spring_stiffness"] * view.angle
    found, place = [], 2 * REST
    while place < view.time.size:
        rest = view.angle[place - 2 * REST : place - REST]
        gone = np.abs(view.angle[place - REST : place + 1] - rest.mean()) > LOOSE
        if 0.1 < rest.mean() < 1.5 and np.ptp(rest) < LOOSE and gone[-1]:
            found.append(free[place - REST + int(np.argmax(gone)) - 1])
            place += REST
        place += 1
    return np.array(found)


def drawn(diagnosis: pr.Diagnosis) -> Figure:
    """The picture of a diagnosis."""
    signals, laws = diagnosis.found.signals, diagnosis.found.exhibits.characteristics
    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    above, below = figure.subplots(2, height_ratios=[3, 2])
    inside = (signals["time"] >= SHOWN[0]) & (signals["time"] <= SHOWN[1])
    for name, words in NAMES.items():
        above.plot(signals["time"][inside], signals[name][inside], color=COLOURS[name], linewidth=1.2, label=words)
    above.set(xlabel="time [s]", ylabel="Hall voltage [V]", xlim=SHOWN)
    law = next(each for each in laws if each.id == "friction")
    for name in ("nominal", "final"):
        below.plot(*law.curves[name], color=COLOURS[name], linewidth=1.2, label=f"friction {NAMES[name]}")
    points, broken = law.points, breakaways(diagnosis)
    below.errorbar(
        points.x, points.y, points.error, fmt="o", markersize=3, linewidth=0.8, color=COLOURS["measured"],
        label="recorded, in motion",
    )  # fmt: skip
    below.plot(
        0.02 * SLOW * np.sign(broken),
        broken,
        "d",
        color=COLOURS["input"],
        markersize=5,
        label="recorded, broke loose",
    )
    below.set(xlabel="velocity [rad/s]", ylabel="friction [N.m]", xlim=(-SLOW, SLOW))
    for axes in (above, below):
        axes.grid(alpha=0.25)
        axes.legend(frameon=False, fontsize=8, ncols=4, loc="upper left")
    return figure


def main() -> None:
    """Diagnose the recording and draw it."""
    diagnosis = pr.diagnose(ROOT / "examples" / "bench.csv", actuator="pierburg")
    drawn(diagnosis).savefig(Path(__file__).with_name("first.png"), dpi=100)


if __name__ == "__main__":
    main()
