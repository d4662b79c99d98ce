"""The recordings of one real machine in two halves: the model for one half is diagnosed from the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

HALVES = 2
ENDINGS = (".mcap", ".csv", ".db3")


@dataclass(frozen=True)
class Machine:
    """What is at hand of one machine: its recordings by name, and the model that stands for it before any diagnosis.

    The model is `known` where it was diagnosed from other recordings already: then all of these are held against it.
    `left_out` says which files were not taken, and why.
    """

    described: Model
    recordings: dict[str, Recording]
    known: bool = False
    left_out: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """That of the actuator."""
        return self.described.actuator.name

    def half(self, name: str) -> int:
        """Which half the recording called `name` belongs to: every other one, by name."""
        return list(self.recordings).index(name) % HALVES

    def others(self, half: int) -> dict[str, Recording]:
        """The recordings that are not in a half, from which its model is diagnosed."""
        return {name: each for name, each in self.recordings.items() if self.half(name) != half}


def machine_in(folder: Path, described: Model, read: Callable[[Path], Recording], known: bool = False) -> Machine:
    """The machine whose recordings lie in `folder`, each read by `read`.

    InputError where there are not two of them, or none for a model that is `known`. A recording that lacks messages is
    left out: written again, it would no longer tell that it does.
    """
    recordings: dict[str, Recording] = {}
    left_out: list[str] = []
    for path in recordings_in(folder):
        recording = read(path)
        if recording.losses:
            left_out.append(f"{path.name}: {recording.warning or 'samples are missing'}")
        elif path.stem in recordings:
            raise InputError(f"{folder} holds two recordings called {path.stem}, expected a name for each. Rename one.")
        else:
            recordings[path.stem] = recording
    if len(recordings) < (1 if known else HALVES):
        told = f" ({'; '.join(left_out)})" if left_out else ""
        raise InputError(
            f"{folder} holds {len(recordings)} whole recordings{told}, expected two or more of one machine, since one"
            " half is held against the model of the other. Add recordings, or name a model diagnosed from others with"
            " --model."
        )
    return Machine(described, recordings, known, tuple(left_out))


def recordings_in(folder: Path) -> Sequence[Path]:
    """The recordings in a folder, by name: files, and folders that rosbag2 wrote."""
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder, expected one that holds recordings of one machine.")
    found = [path for path in folder.iterdir() if path.suffix in ENDINGS or (path / "metadata.yaml").exists()]
    return sorted(found, key=lambda path: path.name)
