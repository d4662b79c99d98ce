"""Reads rosbag2 directories: MCAP through the project's own stream reader, all else through `rosbags`."""

from __future__ import annotations

from pathlib import Path

import yaml
from rosbags.rosbag2 import Reader, ReaderError

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.mcap_file import read_mcap
from pierburg_ros.recording.formats.messages import Bag, Wanted


def read_bag(path: Path, wanted: Wanted) -> Bag:
    """The messages of an MCAP file, a sqlite3 file or a rosbag2 directory, on the topics `wanted`."""
    bag = Bag(path.name, wanted)
    if path.is_dir():
        files = mcap_files(path)
        for file in files:
            read_mcap(file, bag)
        if not files:
            read_storage(path, bag)
    elif path.suffix == ".db3":
        read_storage(path, bag)
    else:
        read_mcap(path, bag)
    return bag


def mcap_files(folder: Path) -> list[Path]:
    """The plain MCAP files of a rosbag2 directory as they were written; none where it stores otherwise.

    They are read here and not through `rosbags`, which drops the publish times.
    """
    metadata = folder / "metadata.yaml"
    if not metadata.exists():
        present = sorted(folder.glob("*.mcap"))
        if len(present) == 1:
            return present
        raise InputError(
            f"{folder.name} is a folder without metadata.yaml ({len(present)} MCAP files), expected a rosbag2"
            " directory. Name one of its files."
        )
    try:
        information = yaml.safe_load(metadata.read_text())["rosbag2_bagfile_information"]
        names, compressed = information["relative_file_paths"], information.get("compression_mode")
    except (yaml.YAMLError, KeyError, TypeError) as error:
        raise InputError(
            f"{folder.name}/metadata.yaml does not list the files of a rosbag2 recording."
            " Restore it with 'ros2 bag reindex', or name one of the files."
        ) from error
    absent = [name for name in names if not (folder / name).exists()]
    if absent:
        raise InputError(
            f"{folder.name}/metadata.yaml lists {absent[0]}, which does not exist, expected every file of the"
            " recording. Restore it, or name one of the files."
        )
    plain = not compressed and all(name.endswith(".mcap") for name in names)
    return [folder / name for name in names] if plain else []


def read_storage(path: Path, bag: Bag) -> None:
    """Add the messages of any storage that `rosbags` reads to `bag`; they have a log time and no other."""
    try:
        with Reader(path) as reader:
            kept = [link for link in reader.connections if bag.declare(link.topic, link.msgtype)]
            for connection, log_time, data in reader.messages(kept) if kept else ():
                bag.headers[connection.topic].append((log_time, 0, 0, bag.count))
                bag.data[connection.topic].append(bytes(data))
                bag.count += 1
    except ReaderError as error:
        raise InputError(
            f"{path.name} does not open as a rosbag2 recording ({error}). Give an .mcap, a rosbag2 directory or a .csv."
        ) from error
