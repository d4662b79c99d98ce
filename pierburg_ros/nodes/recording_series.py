"""Where recordings go: one file after another under one name, or a rosbag2 directory of them."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import yaml

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.recording_file import RecordingFile
from pierburg_ros.recording.formats.mcap_writer import bag_metadata


class RecordingSeries:
    """Names, opens and finishes the files of one recorder."""

    def __init__(self, output: str, as_bag: bool, now: datetime) -> None:
        """`output` is a file or a folder, to which the time `now` is then added."""
        self._as_bag = as_bag
        self._files: list[RecordingFile] = []
        self._first = first_path(output, as_bag, now.strftime("%Y-%m-%dT%H-%M-%S"))

    def open(self) -> RecordingFile:
        """The next file; InputError where it cannot be written."""
        path = self._next_path()
        try:
            file = RecordingFile(path)
        except FileExistsError as error:
            raise InputError(f"{path} exists and is not overwritten; choose another output.") from error
        except OSError as error:
            raise InputError(f"{path} cannot be written ({error.strerror}); choose another output.") from error
        self._files.append(file)
        return file

    def finish(self) -> None:
        """Complete the file that was opened last."""
        self._files[-1].finish()
        if self._as_bag:
            writers = {file.path.name: file.writer for file in self._files}
            text = yaml.safe_dump(bag_metadata(writers), sort_keys=False)
            (self._first.parent / "metadata.yaml").write_text(text, encoding="utf-8")

    def _next_path(self) -> Path:
        number = len(self._files)
        if self._as_bag:
            return self._first.with_name(f"{self._first.stem}_{number}.mcap")
        return self._first.with_name(f"{self._first.stem}_{number}.mcap") if number else self._first


def first_path(output: str, as_bag: bool, time: str) -> Path:
    """The first file: in a bag named like its folder, otherwise as given or with the `time` in its name."""
    path = Path(output)
    if as_bag:
        if path.suffix == ".mcap":
            raise InputError(f"{output} names a file; a rosbag2 recording is a folder. Leave out '.mcap'.")
        folder = path / time if path.is_dir() or output.endswith("/") else path
        if (folder / "metadata.yaml").exists():
            raise InputError(f"{folder} holds a recording; choose another output.")
        return folder / f"{folder.name}.mcap"
    return path if path.suffix == ".mcap" else path / f"{time}.mcap"
