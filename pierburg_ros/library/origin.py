"""Where a result comes from, for its page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pierburg_ros.actuators import Actuator
from pierburg_ros.pages.provenance import provenance
from pierburg_ros.recording import Recording


def origin(actuator: Actuator, recordings: Sequence[Recording]) -> tuple[list[tuple[str, str]], list[Path]]:
    """What a page says of its origin, and the files of the recordings, as far as they were read from files."""
    paths = {recording.name: recording.path for recording in recordings}
    return provenance(actuator, paths), [path for path in paths.values() if path is not None]
