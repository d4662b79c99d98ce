"""What the figures share: an empty figure and its file."""

from __future__ import annotations

from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

FOLDER = Path(__file__).parent
Numbers = dict[str, str]
"""What a figure adds to README.template.md, by placeholder."""


def empty_figure(width: float = 7.5, height: float = 4.5) -> Figure:
    """A figure that draws to a file."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, number: int) -> None:
    """Save the paper's figure `number` as PNG."""
    figure.savefig(FOLDER / f"figure_{number:02}.png", dpi=110)
