"""Writes the layouts for Foxglove and PlotJuggler: `python layouts/write_layouts.py` replaces those in this folder.

One for each kind of file: a recorded loop, the replay.mcap of a replay, the diagnosis.mcap of a diagnosis. The form is
what the viewers themselves write when a layout is exported.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

FOLDER = Path(__file__).parent
COLOURS = ("#7f7f7f", "#d62728", "#1f77b4", "#2ca02c")


@dataclass(frozen=True)
class Series:
    """A number of a topic as either viewer names it, and what a legend calls it."""

    foxglove: str
    plotjuggler: str
    label: str


@dataclass(frozen=True)
class Layout:
    """Plots one above the other, by their titles; below them the panel of a viewer that shows a topic of texts."""

    plots: dict[str, tuple[Series, ...]]
    texts: tuple[str, str]


def number(topic: str, label: str) -> Series:
    """A topic of std_msgs/Float64."""
    return Series(f"{topic}.data", f"{topic}/data", label)


def joint(topic: str, name: str, field: str, label: str) -> Series:
    """A field of the joint `name` in a topic of sensor_msgs/JointState that holds no other joint."""
    return Series(f"{topic}.{field}[0]", f"{topic}/{name}/{field}", label)


LAYOUTS = {
    "loop": Layout(
        {
            "angle [rad]": (
                joint("/joint_states", "swirl_shaft", "position", "angle"),
                number("/active_setpoint", "setpoint"),
            ),
            "speed [rad/s]": (joint("/joint_states", "swirl_shaft", "velocity", "speed"),),
            "Hall voltage [V]": (number("/hall_voltage", "Hall voltage"),),
            "duty [1]": (number("/applied_duty", "applied"), number("/duty", "commanded")),
        },
        ("DiagnosticSummary", "/diagnostics"),
    ),
    "replay": Layout(
        {
            "measured and simulated": (
                number("/replay/measured", "measured"),
                number("/replay/simulated", "simulated"),
            ),
            "residual": (number("/replay/residual", "measured less simulated"),),
            "worst stretch: share of the residual's energy": (number("/replay/window_share", "share"),),
            "command": (number("/replay/command", "command"),),
        },
        ("RosOut", "/replay/remarks"),
    ),
    "diagnosis": Layout(
        {
            "measured, nominal and corrected": (
                number("/diagnosis/measured", "measured"),
                number("/diagnosis/nominal", "nominal model"),
                number("/diagnosis/corrected", "corrected model"),
            ),
            "residual": (
                number("/diagnosis/nominal_residual", "of the nominal model"),
                number("/diagnosis/residual", "of the corrected model"),
            ),
            "windows: share of the mismatch": (number("/diagnosis/window_share", "share"),),
            "command": (number("/diagnosis/command", "command"),),
        },
        ("RosOut", "/diagnosis/remarks"),
    ),
}


def foxglove(layout: Layout) -> str:
    """The layout as Foxglove imports it: panels by their ids, and a tree that halves the window for them."""
    panels: dict[str, dict[str, Any]] = {
        f"Plot!plot{place}": foxglove_plot(title, plot) for place, (title, plot) in enumerate(layout.plots.items())
    }
    kind, topic = layout.texts
    texts = {"topicToRender": topic}
    texts |= {"searchTerms": [], "minLogLevel": 1} if kind == "RosOut" else {"minLevel": 0, "pinnedIds": []}
    panels[f"{kind}!texts"] = texts
    content = {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": stacked(list(panels)),
    }
    return json.dumps(content, indent=1) + "\n"


def foxglove_plot(title: str, plot: tuple[Series, ...]) -> dict[str, Any]:
    """A panel of Foxglove that plots over the log time."""
    return {
        "foxglovePanelTitle": title,
        "paths": [
            {
                "value": each.foxglove,
                "label": each.label,
                "color": colour,
                "enabled": True,
                "timestampMethod": "receiveTime",
            }
            for each, colour in zip(plot, COLOURS, strict=False)
        ],
        "xAxisVal": "timestamp",
        "isSynced": True,
        "showLegend": True,
        "legendDisplay": "floating",
        "showPlotValuesInLegend": False,
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "sidebarDimension": 240,
    }


def stacked(panels: list[str]) -> str | dict[str, Any]:
    """Panels one above the other, each of the same height."""
    if len(panels) == 1:
        return panels[0]
    below = stacked(panels[1:])
    share = round(100.0 / len(panels), 1)
    return {"direction": "column", "first": panels[0], "second": below, "splitPercentage": share}


def plotjuggler(name: str, layout: Layout) -> str:
    """The layout as PlotJuggler loads it: one tab, its plots one above the other; it shows no texts."""
    root = ElementTree.Element("root")
    window = ElementTree.SubElement(root, "tabbed_widget", name="Main Window", parent="main_window")
    tab = ElementTree.SubElement(window, "Tab", tab_name=name, containers="1")
    count = len(layout.plots)
    sizes = ";".join([f"{1.0 / count:.6f}"] * count)
    container = ElementTree.SubElement(tab, "Container")
    splitter = ElementTree.SubElement(container, "DockSplitter", orientation="-", count=str(count), sizes=sizes)
    for title, plot in layout.plots.items():
        area = ElementTree.SubElement(splitter, "DockArea", name=title)
        drawn = ElementTree.SubElement(
            area, "plot", mode="TimeSeries", style="Lines", flip_x="false", flip_y="false", line_width="1.0"
        )
        ElementTree.SubElement(drawn, "limitY")
        for each, colour in zip(plot, COLOURS, strict=False):
            ElementTree.SubElement(drawn, "curve", name=each.plotjuggler, color=colour)
    ElementTree.SubElement(window, "currentTabIndex", index="0")
    ElementTree.SubElement(root, "use_relative_time_offset", enabled="1")
    ElementTree.indent(root, " ")
    return "<?xml version='1.0' encoding='UTF-8'?>\n" + ElementTree.tostring(root, encoding="unicode") + "\n"


def texts() -> dict[str, str]:
    """The content of every layout by the name of its file."""
    written = {f"foxglove_{name}.json": foxglove(layout) for name, layout in LAYOUTS.items()}
    return written | {f"plotjuggler_{name}.xml": plotjuggler(name, layout) for name, layout in LAYOUTS.items()}


if __name__ == "__main__":
    for file, text in texts().items():
        (FOLDER / file).write_text(text, encoding="utf-8")
