"""Reads rosbag2 directories: the files that their metadata lists, plain or packed with zstd."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

from pierburg_ros.errors import InputError
from pierburg_ros.intake import opened, read_yaml
from pierburg_ros.recording.formats.compression import Damaged, most_unpacked, unpack_file, unpacked
from pierburg_ros.recording.formats.format import Format, as_bag
from pierburg_ros.recording.formats.mcap_file import read_mcap
from pierburg_ros.recording.formats.messages import Bag
from pierburg_ros.recording.formats.sqlite_file import read_sqlite

STORAGES: dict[str, Callable[[Path, Bag], None]] = {".mcap": read_mcap, ".db3": read_sqlite}
LARGEST_MESSAGE = 16 << 20
"""Bytes of one packed message at most; those that are read have 12 to 200."""


@dataclass(frozen=True)
class Listed:
    """What metadata.yaml says: the files, and whether `file` or `message` is packed."""

    files: list[Path]
    packed: str


def read_rosbag2(folder: Path, bag: Bag) -> None:
    """Add the messages of the rosbag2 directory `folder` to `bag`, file by file."""
    listed = listed_in(folder)
    if listed.packed == "message":
        bag.unpack = unpacked_message
    for file in listed.files:
        if listed.packed == "file":
            read_packed(file, bag)
        else:
            read_storage(file, bag)


def read_storage(file: Path, bag: Bag) -> None:
    """Add the messages of one file to `bag`."""
    if file.suffix not in STORAGES:
        raise InputError(f"{file.name} is not a storage of rosbag2 known here, expected {' or '.join(STORAGES)}.")
    STORAGES[file.suffix](file, bag)


def read_packed(file: Path, bag: Bag) -> None:
    """Unpack one file to where it can be read, and add its messages to `bag`."""
    with tempfile.TemporaryDirectory() as folder, opened(file, "a packed file of rosbag2") as source:
        target = Path(folder) / file.stem
        most = min(most_unpacked(os.fstat(source.fileno()).st_size), shutil.disk_usage(folder).free // 2)
        with target.open("wb") as content:
            unpack_file(source, content, most, file.name)
        read_storage(target, bag)


def unpacked_message(data: bytes) -> bytes:
    """The CDR of a message packed with zstd."""
    try:
        return unpacked("zstd", data, LARGEST_MESSAGE)
    except Damaged as error:
        raise InputError(f"A packed message is damaged ({error}), expected zstd. Record again.") from error


def listed_in(folder: Path) -> Listed:
    """The files of the recording in `folder`."""
    metadata = folder / "metadata.yaml"
    if not metadata.exists():
        present = sorted(folder.glob("*.mcap"))
        if len(present) == 1:
            return Listed(present, "")
        if present:
            raise InputError(
                f"{folder.name} is a folder without metadata.yaml and with {len(present)} MCAP files, expected a"
                " rosbag2 directory. Restore it with 'ros2 bag reindex', or name one of its files."
            )
        if any(folder.glob("*.csv")):
            raise InputError(
                f"{folder.name} is a folder of tables, expected a signal map that says which file each signal is in."
                f" 'pierburg inspect {folder.name} --write-signals FILE' writes one to edit."
            )
        raise InputError(
            f"{folder.name} is a folder without metadata.yaml ({len(present)} MCAP files), expected a rosbag2"
            " directory. Name one of its files."
        )
    content = read_yaml(metadata, "the metadata of a rosbag2 recording").content
    given = content.get("rosbag2_bagfile_information") if isinstance(content, dict) else None
    information: dict[str, Any] = given if isinstance(given, dict) else {}
    names = information.get("relative_file_paths")
    if not names or not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise InputError(
            f"{folder.name}/metadata.yaml does not list the files of a rosbag2 recording."
            " Restore it with 'ros2 bag reindex', or name one of the files."
        )
    return Listed(files_of(folder, names), packing(folder, information))


def packing(folder: Path, information: dict[str, Any]) -> str:
    """What is packed: file, message or nothing."""
    mode, kind = (str(information.get(f"compression_{name}") or "").lower() for name in ("mode", "format"))
    mode = "" if mode == "none" else mode
    if mode not in ("", "file", "message") or (mode and kind != "zstd"):
        raise InputError(
            f"{folder.name}/metadata.yaml names the compression {kind!r} of each {mode!r}, expected zstd of each file"
            " or message. Convert it with 'ros2 bag convert'."
        )
    return mode


def files_of(folder: Path, names: list[str]) -> list[Path]:
    """The files of these names, each once, in `folder` itself; early versions wrote the folder before the name."""
    files = [folder / PurePath(name).name for name in names]
    absent = [file.name for file in files if not file.is_file()]
    if absent:
        raise InputError(
            f"{folder.name}/metadata.yaml lists {absent[0]}, which does not exist, expected every file of the"
            " recording. Restore it, or name one of the files."
        )
    if len(set(files)) < len(files):
        raise InputError(f"{folder.name}/metadata.yaml lists a file twice, expected each once. Repair it.")
    return files


FORMAT = Format("a rosbag2 directory", lambda path, _: path.is_dir(), as_bag(read_rosbag2))
