"""Where recordings lie: a folder, a glob or a table, on this machine or wherever fsspec reads from."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Any

from pierburg_ros.errors import InputError

ENDINGS = (".mcap", ".csv", ".db3")
BAG = "metadata.yaml"
"""What marks a folder as a rosbag2 recording."""


def file_system(path: str) -> tuple[Any, str]:
    """What reads `path`, and the path as it knows it; None for this machine's own files."""
    if "://" not in path and "::" not in path:
        return None, path
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise InputError(
            f"{path} needs fsspec, which is not installed. Install it with pip install 'pierburg_ros[fleet]'."
        ) from None
    try:
        system, inner = url_to_fs(path)
    except (ImportError, ValueError) as error:
        raise InputError(f"{path} cannot be opened ({error}), expected a path that fsspec reads.") from None
    return system, str(inner)


def recordings_below(where: str) -> tuple[str, list[str]]:
    """The folder that paths are told from, and the recordings in a folder or of a glob, by name; InputError if none."""
    system, inner = file_system(where)
    globbed = any(mark in inner for mark in "*?[")
    base = _fixed_part(inner) if globbed else inner
    if system is None:
        if not globbed and not Path(inner).is_dir():
            raise InputError(f"{where} is no folder, expected a folder, a glob in quotes or a table of recordings.")
        base = str(Path(base))
        found = [str(each) for each in Path(base).glob(below(base, str(Path(inner))) if globbed else "**/*")]
    else:
        found = list(system.glob(inner) if globbed else system.find(base))
    recordings = sorted(_recordings(found, globbed))
    if not recordings:
        raise InputError(
            f"{where} holds no recording, expected files ending in {', '.join(ENDINGS)} or rosbag2 folders."
        )
    named = recordings if system is None else [system.unstrip_protocol(each) for each in recordings]
    return (base if system is None else system.unstrip_protocol(base)), named


def _recordings(found: list[str], globbed: bool) -> Iterator[str]:
    """The recordings among paths: files of a known ending, and folders of rosbag2 in place of their files."""
    bags = {str(PurePosixPath(each).parent) for each in found if PurePosixPath(each).name == BAG}
    yield from bags
    for each in found:
        inside = any(str(parent) in bags for parent in PurePosixPath(each).parents)
        if not inside and each not in bags and each.endswith(ENDINGS):
            yield each


def below(base: str, path: str) -> str:
    """What of a path is below a folder; all of it where that is the present one."""
    return path[len(base) :].lstrip("/") if base != "." and path.startswith(base) else path


def _fixed_part(pattern: str) -> str:
    """The folder of a glob above its first wildcard."""
    parts = PurePosixPath(pattern).parts
    fixed = [part for n, part in enumerate(parts) if not any(set("*?[") & set(each) for each in parts[: n + 1])]
    return str(PurePosixPath(*fixed)) if fixed else "."


@contextmanager
def at_hand(path: str) -> Iterator[Path]:
    """A recording as a file or folder of this machine: itself, or a copy that is gone after the block."""
    system, inner = file_system(path)
    if system is None:
        yield Path(inner)
        return
    with tempfile.TemporaryDirectory(prefix="pierburg-") as folder:
        copy = Path(folder) / PurePosixPath(inner).name
        try:
            system.get(inner, str(copy), recursive=system.isdir(inner))
        except FileNotFoundError:
            raise InputError(f"{path} does not exist, expected a recording. Check the path.") from None
        except OSError as error:
            raise InputError(f"{path} cannot be read ({error}), expected a recording.") from None
        yield copy


def digest(path: Path) -> str:
    """SHA-256 of a recording: of its file, or of the files of its folder by name."""
    found = hashlib.sha256()
    for file in sorted(each for each in path.rglob("*") if each.is_file()) if path.is_dir() else [path]:
        if path.is_dir():
            found.update(file.relative_to(path).as_posix().encode())
        with file.open("rb") as stream:
            while block := stream.read(1 << 20):
                found.update(block)
    return found.hexdigest()
