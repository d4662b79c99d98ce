"""Where a result comes from, for its page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pierburg_ros.actuators import Actuator
from pierburg_ros.library.output import published
from pierburg_ros.pages.page import Sources
from pierburg_ros.pages.provenance import provenance
from pierburg_ros.recording import Recording


def origin(actuator: Actuator, recordings: Sequence[Recording], model: Path) -> tuple[list[tuple[str, str]], Sources]:
    """What a page says of its origin, and how to name its recordings and its `model` file on a command line."""
    by_name = {recording.name: recording for recording in recordings}
    rows = provenance(actuator, {name: recording.path for name, recording in by_name.items()}, published)
    read = [[str(published(each.path)), *each.read_with] for each in by_name.values() if each.path is not None]
    return rows, Sources(read, str(published(model)))
