"""A design of the discriminating experiment in words and as a picture."""

from __future__ import annotations

from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pierburg_ros.actuators.wording import quantity_title
from pierburg_ros.identification.experiment.discriminate import DETECTABLE, Design
from pierburg_ros.identification.experiment.excitation import purpose
from pierburg_ros.recording.recording import UNITS


def words(design: Design, names: tuple[str, str], unit: str, noise: float) -> str:
    """The sequence in words, and the expected separation of the two explanations."""
    lines = [
        f"{names[0]} against {names[1]}, {design.time[-1] - design.time[0]:.0f} s,"
        f" duty {design.duty.min():.3f} to {design.duty.max():.3f}:"
    ]
    edges = [round(share * design.time[-1]) for share in (0.0, 0.25, 0.5, 0.75, 1.0)]
    for start, end, segment in zip(edges[:-1], edges[1:], design.segments, strict=True):
        lines.append(f"  {start} to {end} s: {segment.recipe}. {purpose(segment.recipe)}")
    lines.append(
        f"After refitting, the two answers stay {design.left:.3g} {unit} rms apart: over the whole recording"
        f" {design.separation:.1f} standard deviations of a sensor noise of {noise:.3g} {unit}."
    )
    if design.settles:
        lines.append("One such recording is expected to settle the question.")
    else:
        lines.append(
            f"Below {DETECTABLE:g} deviations one recording does not settle the question: from duty and shaft"
            " position these explanations look alike. Measure the current or the resistance instead."
        )
    return "\n".join(lines)


def write_picture(path: Path, design: Design, names: tuple[str, str], quantity: str) -> None:
    """Write duty and both predicted responses as a PNG."""
    figure = Figure(figsize=(10, 6), layout="constrained")
    FigureCanvasAgg(figure)
    answer, difference, duty = figure.subplots(3, sharex=True, height_ratios=[4, 3, 2])
    answer.plot(design.time, design.first_answer, color="#d62728", linewidth=1, label=names[0].replace("$", r"\$"))
    answer.plot(design.time, design.second_answer, color="#1f77b4", linewidth=1, label=names[1].replace("$", r"\$"))
    answer.legend(fontsize=8, loc="upper right")
    title = f"before refitting; after it {design.separation:.1f} noise deviations apart"
    answer.set_title(title, fontsize=10)
    apart = design.first_answer - design.second_answer
    difference.plot(design.time, apart, color="black", linewidth=0.8)
    duty.step(design.time, 100.0 * design.duty, where="post", color="#2ca02c", linewidth=0.8)
    answer.set_ylabel(quantity_title(quantity, UNITS[quantity]))
    difference.set_ylabel("difference")
    duty.set(ylabel="duty [%]", xlabel="time [s]")
    figure.savefig(path, dpi=120)
