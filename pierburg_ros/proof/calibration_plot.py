"""Draws the calibration curve: how often a name is right, over the confidence that it was given with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.proof.calibration import Class


def draw(classes: Sequence[Class], path: Path) -> None:
    """The calibration curve: what is right over what was said, with 95 % intervals. Writes a picture to `path`."""
    figure = Figure(figsize=(5.0, 4.6), layout="constrained")
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color="0.6", linestyle="--", label="what is said is right as often")
    said = [each.said for each in classes]
    right = [each.right.value or 0.0 for each in classes]
    below = [share - each.right.interval[0] for share, each in zip(right, classes, strict=True)]
    above = [each.right.interval[1] - share for share, each in zip(right, classes, strict=True)]
    axes.errorbar(said, right, yerr=[below, above], fmt="o", capsize=3, label="names, with 95 % interval")
    for each in classes:
        low = each.said, each.right.interval[0]
        axes.annotate(f"n = {each.right.total}", low, (-5, 0), textcoords="offset points", ha="right")
    axes.set(xlim=(0, 1.02), ylim=(0, 1.05), xlabel="confidence that was said", ylabel="share that is right")
    axes.legend(loc="lower right", frameon=False)
    FigureCanvasAgg(figure)
    figure.savefig(path, dpi=120)
