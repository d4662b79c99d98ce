"""Figures 9 to 12: the closed loop with more resistance, and under a square signal."""

from __future__ import annotations

import numpy as np
from drawing import Numbers, empty_figure, save

from pierburg_ros.closed_loop import Run, simulate_loop
from pierburg_ros.closed_loop.metrics import Metrics, step_metrics
from pierburg_ros.control import Schedule, Settings
from pierburg_ros.plant import Model

RATE = 500.0
NOISE = 0.003
REST = 0.5
HOLD = 2.0
LEVELS = (20.0, 60.0, 80.0, 40.0, 10.0)
"""Setpoints [degrees] of Figs. 9 to 11, which the paper does not state."""
SQUARE = (60.0, 20.0, 60.0, 20.0)
FIGURES = {9: 1.0, 10: 1.17, 11: 1.42}
"""Total resistance over that of the motor."""


def draw(model: Model) -> Numbers:
    """Draw the four figures."""
    numbers = {"levels": ", ".join(f"{level:g}" for level in LEVELS)}
    for number, factor in FIGURES.items():
        total = factor * model.values["armature_resistance"]
        run = run_levels(model.with_values({"armature_resistance": total}), LEVELS)
        draw_run(run, number, f"total resistance {factor:g} R, default settings, 3 mV noise")
        numbers[f"loop_{number:02}"] = summary(judged(run, LEVELS))
    run = run_levels(model, SQUARE)
    draw_run(run, 12, "square signal, default settings, 3 mV noise")
    metrics = judged(run, SQUARE)
    return {
        **numbers,
        "loop_12": summary(metrics),
        "overshoot_opening": f"{100.0 * max(each.overshoot for each in metrics[2::2]):.2f}",
        "overshoot_closing": f"{100.0 * max(each.overshoot for each in metrics[1::2]):.2f}",
    }


def run_levels(model: Model, levels: tuple[float, ...]) -> Run:
    """The closed loop from rest through setpoints [degrees], each held for 2 s."""
    time = np.concatenate([[0.0], REST + HOLD * np.arange(len(levels))])
    schedule = Schedule(time, np.radians([0.0, *levels]))
    return simulate_loop(model, Settings(), schedule, REST + HOLD * len(levels), RATE, NOISE)


def judged(run: Run, levels: tuple[float, ...]) -> list[Metrics]:
    """Metrics of every step of `run`."""
    length, begin = round(HOLD * RATE), round(REST * RATE)
    found = []
    for index, (start, target) in enumerate(zip((0.0, *levels[:-1]), levels, strict=True)):
        part = slice(begin + index * length, begin + (index + 1) * length)
        course = run.angle[part], run.duty[part]
        found.append(step_metrics(np.radians(start), np.radians(target), *course, 1.0 / RATE))
    return found


def draw_run(run: Run, number: int, title: str) -> None:
    """Setpoint, angle and duty of a run as the paper's figure `number`."""
    figure = empty_figure(8.0, 5.0)
    angle, duty = figure.subplots(2, sharex=True, height_ratios=[3, 1])
    setpoint = np.degrees(run.setpoint)
    angle.step(run.time, setpoint, where="post", color="grey", linewidth=1, label="setpoint")
    angle.plot(run.time, np.degrees(run.angle), color="#d62728", linewidth=1.2, label="shaft")
    angle.set_ylabel("angle [degrees]")
    angle.set_title(title, fontsize=10)
    angle.legend(fontsize=8)
    duty.plot(run.time, 100.0 * run.duty, color="#2ca02c", linewidth=0.8)
    duty.set(ylabel="duty [%]", xlabel="time [s]")
    save(figure, number)


def summary(metrics: list[Metrics]) -> str:
    """The steps in one sentence."""
    settling = [each.settling for each in metrics]
    overshoot = max(each.overshoot for each in metrics)
    error = np.degrees(max(each.steady_state_error for each in metrics))
    return (
        f"{len(metrics)} steps, settled after {min(settling):.3f} to {max(settling):.3f} s, overshoot at most"
        f" {100.0 * overshoot:.2f} %, mean error at standstill at most {error:.2f} degree"
    )
