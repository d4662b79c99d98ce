"""Figures 6 and 7: structure of the PIFLC, its sets, and the rule surface of Table II."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from drawing import Numbers, empty_figure, save
from matplotlib.axes import Axes

from pierburg_ros.control import Settings, fuzzy

BOXES = {"setpoint": 0.0, "error": 1.6, "PI": 3.2, "fuzzy stage\nTable II": 4.8, "valve": 6.4}
"""Signal path of Fig. 6 from left to right."""
FRAME = {"boxstyle": "round", "fc": "white"}


def draw() -> Numbers:
    """Draw both figures."""
    structure()
    return sets(Settings())


def structure() -> None:
    """Fig. 6."""
    figure = empty_figure(9.0, 3.0)
    axes = figure.subplots()
    axes.set(xlim=(-0.8, 7.2), ylim=(-1.7, 0.7))
    axes.axis("off")
    for name, place in BOXES.items():
        axes.text(place, 0.0, name, ha="center", va="center", bbox=FRAME)
    axes.text(3.2, -0.8, "derivative", ha="center", va="center", bbox=FRAME)
    for start, end in pairwise(BOXES.values()):
        arrow(axes, (start + 0.6, 0.0), (end - 0.6, 0.0))
    arrow(axes, (1.75, -0.2), (2.65, -0.8))
    arrow(axes, (3.75, -0.8), (4.6, -0.3))
    axes.plot([6.4, 6.4, 1.6], [-0.2, -1.4, -1.4], color="black", linewidth=1)
    arrow(axes, (1.6, -1.4), (1.6, -0.2))
    axes.text(4.8, -1.32, "Hall voltage", ha="center", fontsize=8)
    axes.text(5.6, 0.08, "duty", ha="center", fontsize=8)
    save(figure, 6)


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """A line of the block diagram."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "->"})


def sets(settings: Settings) -> Numbers:
    """Fig. 7."""
    figure = empty_figure(11.0, 4.2)
    grid = figure.add_gridspec(2, 2, width_ratios=[1, 1.2])
    draw_sets(figure.add_subplot(grid[0, 0]), settings.pi_output_support, "PI output [V]")
    draw_sets(figure.add_subplot(grid[1, 0]), settings.derivative_support, "derivative of error [V/s]")
    surface = figure.add_subplot(grid[:, 1], projection="3d")
    output = np.linspace(-1.0, 1.0, 41) * settings.pi_output_support
    derivative = np.linspace(-1.0, 1.0, 41) * settings.derivative_support
    record = settings.record()
    duty = np.array([[fuzzy.duty_of(record, u, d) for u in output] for d in derivative])
    surface.plot_surface(*np.meshgrid(output, derivative), duty, cmap="viridis", linewidth=0)
    surface.set(xlabel="PI output [V]", ylabel="derivative [V/s]", zlabel="duty")
    save(figure, 7)
    corners = {"NB": duty[0, 0], "N": duty[20, 0], "Z": duty[20, 20], "P": duty[20, -1], "PB": duty[-1, -1]}
    return {
        "pi_output_support": f"{settings.pi_output_support:g}",
        "derivative_support": f"{settings.derivative_support:g}",
        "corners": ", ".join(f"{name} gives {value:+.2f}" for name, value in corners.items()),
    }


def draw_sets(axes: Axes, support: float, label: str) -> None:
    """The three triangles of one input."""
    values = np.linspace(-1.3 * support, 1.3 * support, 400)
    memberships = np.array([fuzzy.memberships(value, support) for value in values])
    for name, membership in zip("NZP", memberships.T, strict=True):
        axes.plot(values, membership, label=name)
    axes.set(xlabel=label, ylabel="membership")
    axes.legend(fontsize=8, loc="center right")
