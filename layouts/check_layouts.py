"""Says which paths of a layout a recording lacks: `python layouts/check_layouts.py RECORDING.mcap LAYOUT...`.

Exit status 1 where there are any. It reads the layouts as they are, and names numbers of a recording as either viewer
does.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from mcap.reader import make_reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

JOINT_STATE = "sensor_msgs/msg/JointState"
TEXTS = "topicToRender"


def first_messages(path: Path) -> dict[str, tuple[str, Any]]:
    """Type and first message of every topic in an MCAP file of ROS 2."""
    types = get_typestore(Stores.EMPTY)
    found: dict[str, tuple[str, Any]] = {}
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            if channel.topic not in found and schema is not None:
                declared = get_types_from_msg(schema.data.decode(), schema.name)
                types.register({name: each for name, each in declared.items() if name not in types.types})
                found[channel.topic] = schema.name, types.deserialize_cdr(message.data, schema.name)
    return found


def foxglove_paths(path: Path) -> set[str]:
    """Every number of a recording as Foxglove writes its path, `/joint_states.position[0]`, and every topic."""
    found = first_messages(path)
    return set(found) | {f"{topic}{name}" for topic, (_, message) in found.items() for name in numbers(message)}


def plotjuggler_paths(path: Path) -> set[str]:
    """Every number of a recording as PlotJuggler names its curve; joints go by their names."""
    found: set[str] = set()
    for topic, (kind, message) in first_messages(path).items():
        if kind == JOINT_STATE:
            fields = [field for field in ("position", "velocity", "effort") if len(getattr(message, field))]
            found |= {f"{topic}/{name}/{field}" for name in message.name for field in fields}
        else:
            found |= {f"{topic}{name.replace('.', '/')}" for name in numbers(message)}
    return found


def numbers(message: Any, place: str = "") -> Iterator[str]:
    """Paths of the numbers in a message, as `.data` and `.position[0]`."""
    if hasattr(message, "__msgtype__"):
        for name in message.__dataclass_fields__:
            if name != "__msgtype__":
                yield from numbers(getattr(message, name), f"{place}.{name}")
    elif isinstance(message, (int, float)):
        yield place
    elif not isinstance(message, str):
        for index, item in enumerate(getattr(message, "tolist", lambda: message)()):
            yield from numbers(item, f"{place}[{index}]")


def asked(layout: Path) -> list[str]:
    """Every path that a layout shows."""
    if layout.suffix == ".xml":
        return [curve.attrib["name"] for curve in ElementTree.parse(layout).iter("curve")]
    panels = json.loads(layout.read_text(encoding="utf-8"))["configById"].values()
    plotted = [path["value"] for panel in panels for path in panel.get("paths", [])]
    return plotted + [panel[TEXTS] for panel in panels if TEXTS in panel]


def missing(layout: Path, recording: Path) -> list[str]:
    """Paths of a layout that the recording does not have."""
    present = plotjuggler_paths(recording) if layout.suffix == ".xml" else foxglove_paths(recording)
    return [path for path in asked(layout) if path not in present]


if __name__ == "__main__":
    recording, *layouts = map(Path, sys.argv[1:])
    lines = [f"{each.name}: {recording.name} has no {path}" for each in layouts for path in missing(each, recording)]
    print("\n".join(lines) or f"{recording.name} has every path of {len(layouts)} layouts")
    sys.exit(bool(lines))
