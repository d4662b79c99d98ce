"""File formats of recordings: READERS says what a file looks like and what reads it; docs/extending.md adds one."""

from __future__ import annotations

from pathlib import Path

from pierburg_ros.errors import InputError
from pierburg_ros.intake import opened
from pierburg_ros.recording.formats import csv_table, mcap_file, rosbag2, sqlite_file
from pierburg_ros.recording.formats.format import Format

READERS: tuple[Format, ...] = (
    rosbag2.FORMAT,
    mcap_file.FORMAT,
    sqlite_file.FORMAT,
    csv_table.FORMAT,
)
"""Every format that is read; the first that a file looks like reads it."""
START = 64
"""Bytes of a file that its format is told by."""


def format_of(path: Path) -> Format:
    """The format of the recording at `path`."""
    start = b""
    if not path.is_dir():
        with opened(path, "a recording") as file:
            start = file.read(START)
    for each in READERS:
        if each.looks_like(path, start):
            return each
    known = ", ".join(each.name for each in READERS)
    raise InputError(f"{path} does not look like a recording, expected one of: {known}. Give another file.")
