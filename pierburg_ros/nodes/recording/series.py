"""Where recordings go: one file after another under one name, or a rosbag2 directory of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from itertools import count
from pathlib import Path

import yaml

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.recording.file import RecordingFile
from pierburg_ros.recording.formats.mcap_writer import bag_metadata

METADATA = "metadata.yaml"


class RecordingSeries:
    """Names, opens and finishes the files of one recorder; names never collide with what exists."""

    def __init__(self, output: str, as_bag: bool, now: datetime) -> None:
        """`output` is a file or a folder, to which the time `now` is then added."""
        self._as_bag = as_bag
        self._files: list[RecordingFile] = []
        self._first, self._is_ours = first_path(output, as_bag, now.strftime("%Y-%m-%dT%H-%M-%S"))

    def open(self) -> RecordingFile:
        """The next file, its rosbag2 directory complete beside it; InputError where it cannot be written."""
        for path in self._names():
            try:
                file = RecordingFile(path)
            except FileExistsError as error:
                if self._files or self._is_ours:
                    continue
                raise InputError(f"{path} exists and is not overwritten; choose another output.") from error
            except OSError as error:
                raise InputError(unwritable(path, error)) from error
            self._files.append(file)
            self._describe()
            return file
        raise AssertionError("the names never end")

    def finish(self, file: RecordingFile) -> None:
        """Complete `file`; OSError where the disk does not take it."""
        file.finish()
        self._describe()

    def give_up(self, file: RecordingFile) -> Path:
        """Mark `file` as cut, where its directory can be told of the new name; its name then."""
        file.give_up()
        try:
            self._describe()
        except InputError:
            file.rename(file.opened_as)
        return file.path

    def _describe(self) -> None:
        """Replace the metadata of a rosbag2 directory; on a full disk those from before stay whole."""
        if not self._as_bag:
            return
        writers = {file.path.name: file.writer for file in self._files}
        text = yaml.safe_dump(bag_metadata(writers), sort_keys=False)
        target = self._first.parent / METADATA
        partial = target.with_suffix(".partial")
        try:
            partial.write_text(text, encoding="utf-8")
            os.replace(partial, target)
        except OSError as error:
            with suppress(OSError):
                partial.unlink()
            raise InputError(unwritable(target, error)) from error

    def _names(self) -> Iterator[Path]:
        """The names to try, from the next number on."""
        stem = self._first.stem
        for number in count(len(self._files)):
            is_plain = number == 0 and not self._as_bag
            yield self._first if is_plain else self._first.with_name(f"{stem}_{number}.mcap")


def first_path(output: str, as_bag: bool, time: str) -> tuple[Path, bool]:
    """The first file, and whether its name is the recorder's own choice and so may get a number.

    In a bag it is named like its folder, otherwise as given or with the `time` in its name.
    """
    path = Path(output)
    if not as_bag:
        return (path, False) if path.suffix == ".mcap" else (path / f"{time}.mcap", True)
    if path.suffix == ".mcap":
        raise InputError(f"{output} names a file; a rosbag2 recording is a folder. Leave out '.mcap'.")
    if path.is_dir() or output.endswith("/"):
        folder = new_folder(path, time)
        return folder / f"{folder.name}.mcap", True
    if (path / METADATA).exists():
        raise InputError(f"{path} holds a recording; choose another output.")
    return path / f"{path.name}.mcap", False


def new_folder(parent: Path, name: str) -> Path:
    """A new folder of this `name`, with a number behind it where another recorder was first."""
    for number in count(1):
        folder = parent / (name if number == 1 else f"{name}_{number}")
        try:
            folder.mkdir(parents=True)
            return folder
        except FileExistsError:
            continue
        except OSError as error:
            raise InputError(unwritable(folder, error)) from error
    raise AssertionError("the numbers never end")


def unwritable(path: Path, error: OSError) -> str:
    """What to say of a file that cannot be written."""
    return f"{path} cannot be written ({error.strerror}); make room or choose another output."
