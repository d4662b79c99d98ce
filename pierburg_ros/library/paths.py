"""Paths as the library's users give them."""

from __future__ import annotations

from pathlib import Path

from pierburg_ros.errors import InputError


def given_path(path: str | Path, argument: str) -> Path:
    """The path that an `argument` gives; InputError where it is empty, which would be the present folder."""
    if path == "":
        raise InputError(f"`{argument}` is empty, expected a path. Name a file or a folder.")
    return Path(path)
