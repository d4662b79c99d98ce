"""What every recording of a fleet is held against, and which result belongs to it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path

from pierburg_ros.budget import Budget
from pierburg_ros.library.model import Model
from pierburg_ros.library.reading import read
from pierburg_ros.recording import Recording
from pierburg_ros.recording.signal_map import SignalMap
from pierburg_ros.version import source_version


@dataclass(frozen=True)
class Task:
    """The model, what a diagnosis may take, where results are kept, and how recordings are read: clock and signal map.

    `version` is that of the sources at the start.
    """

    nominal: Model
    budget: Budget
    results: Path
    time: str | None = None
    signals: SignalMap = field(default_factory=SignalMap)
    version: str = field(default_factory=source_version)

    def read(self, path: Path) -> Recording:
        """The recording at `path`."""
        return read(path, time=self.time, signals=self.signals, actuator=self.nominal.actuator)

    def key(self, digest: str) -> str:
        """The name of the result on a recording with this `digest`: of these settings and this version."""
        settings = (digest, self.version, self.nominal.text(), self.budget, self.time, self.signals)
        return hashlib.sha256("\n".join(map(str, settings)).encode()).hexdigest()[:20]
