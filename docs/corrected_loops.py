"""What `pierburg tune --model` gives for plants with an effect: `python docs/corrected_loops.py`.

Writes its part of docs/developers/measurements.md. A few minutes on an idle machine; the numbers are the same each
time.
"""

from __future__ import annotations

from math import degrees
from pathlib import Path

from pierburg_ros.closed_loop.corrected import Promise, promises, start, starts, task_for
from pierburg_ros.closed_loop.course import Course
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.closed_loop.judgement import judge
from pierburg_ros.closed_loop.plants import HOT, NOMINAL
from pierburg_ros.closed_loop.predictor import dead_time, lag
from pierburg_ros.closed_loop.tune import Task, tune
from pierburg_ros.control import Settings
from pierburg_ros.library.model import Model
from pierburg_ros.library.output import write_whole

DOCUMENT = Path(__file__).parent / "developers/measurements.md"
BEGIN, END = "<!-- corrected loops: written by docs/corrected_loops.py -->", "<!-- end of corrected loops -->"
EFFORT = {"generations": 20, "members": 20, "seed": 1}
MODELS = {
    "input delay 20 ms": {"input_delay.delay": 0.020},
    "sensor lag 9 ms, resistance 4.9 ohm": {"sensor_lag.time_constant": 0.009, "armature_resistance": 4.9},
    "static friction 0.295 N.m": {
        "static_friction.breakaway_torque": 0.295,
        "static_friction.stribeck_velocity": 0.11,
    },
    "backlash 0.072 rad": {"backlash.gap": 0.072, "backlash.motor_friction_share": 0.19},
    "static friction 0.294 N.m, input delay 28 ms": {
        "static_friction.breakaway_torque": 0.294,
        "static_friction.stribeck_velocity": 0.14,
        "input_delay.delay": 0.028,
    },
}
"""Corrected models like those that a diagnosis of the practice recordings gives, and the values they change."""
HEADER = ("plant", "controller", "settling [ms]", "overshoot [%]", "error [°]", "hunting [°]")
HEADER += ("hot: settling [ms]", "hot: overshoot [%]", "cost")


def main() -> None:
    """Tune for every model, and replace the table."""
    rows = [row for name, changes in MODELS.items() for row in rows_of(name, changes)]
    table = "\n".join(f"| {' | '.join(row)} |" for row in (HEADER, ["---", "---", *["---:"] * 7], *rows))
    before, _, rest = DOCUMENT.read_text(encoding="utf-8").partition(BEGIN)
    write_whole(DOCUMENT, f"{before}{BEGIN}\n\n{table}\n\n{END}{rest.partition(END)[2]}")


def rows_of(name: str, changes: dict[str, float]) -> list[tuple[str, ...]]:
    """The loop with the settings as shipped and as tuned: plain, behind a predictor, and with a schedule beside."""
    model = Model.nominal().with_values(changes)
    late = dead_time(model) + lag(model) > 0.0
    plain = task_for(model, Goal(), False, False)
    rows = [row(name, "as shipped", plain, Settings()), row(name, "tuned", plain, tuned(plain))]
    behind = ", predictor" if late else ""
    if late:
        predicting = task_for(model, Goal(), True, False)
        rows.append(row(name, "as shipped, predictor", predicting, start(predicting, Settings())))
        rows.append(row(name, "tuned, predictor", predicting, tuned(predicting)))
    scheduling = task_for(model, Goal(), late, True)
    rows.append(row(name, f"tuned{behind}, schedule", scheduling, tuned(scheduling)))
    return rows


def tuned(task: Task) -> Settings:
    """What a search finds."""
    return tune(task, **EFFORT, known=starts(task, Settings()))


def row(name: str, controller: str, task: Task, settings: Settings) -> tuple[str, ...]:
    """What the loop promises at its worst step."""
    found = promises(judge(task.design, settings, task.plants))
    hot = found[HOT]
    cost = task.cost(settings, Course())
    last = f"{1e3 * hot.settling:.0f}", f"{100 * hot.overshoot:.1f}", f"{cost:.2f}"
    return name, controller, *numbers(found[NOMINAL]), *last


def numbers(promise: Promise) -> tuple[str, ...]:
    """Settling, overshoot, error and hunting for people."""
    return (
        f"{1e3 * promise.settling:.0f}",
        f"{100 * promise.overshoot:.1f}",
        f"{degrees(promise.steady_state_error):.2f}",
        f"{degrees(promise.hunting):.2f}",
    )


if __name__ == "__main__":
    main()
