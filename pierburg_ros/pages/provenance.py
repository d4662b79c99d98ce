"""Where a page comes from: files with their digests, actuator, versions, command and time."""

from __future__ import annotations

import hashlib
import platform
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from pierburg_ros.actuators import Actuator

PACKAGES = ("pierburg_ros", "numpy", "scipy", "numba", "mcap", "plotly")


def provenance(
    actuator: Actuator, recordings: Mapping[str, Path | None], place: Callable[[Path], Path] = Path
) -> list[tuple[str, str]]:
    """What a page says of its origin, in rows of two.

    `recordings` by name, with where each was read from if known; `place` says where that lies when the page is read.
    """
    rows = [("actuator", f"{actuator.name}: {actuator.title}")]
    for name, path in recordings.items():
        rows.append((f"recording {name}", "not read from a file" if path is None else f"{place(path)}{digest(path)}"))
    rows.append(("command", command_line()))
    rows.append(("versions", ", ".join([f"Python {platform.python_version()}", *_versions()])))
    rows.append(("written", datetime.now(timezone.utc).isoformat(timespec="seconds")))
    return rows


def digest(path: Path) -> str:
    """What to say behind a path: size and SHA-256, of a folder those of its files by name; or that it is gone."""
    found = hashlib.sha256()
    size = 0
    try:
        for file in sorted(each for each in path.rglob("*") if each.is_file()) if path.is_dir() else [path]:
            for block in _blocks(file):
                found.update(block)
                size += len(block)
    except OSError as error:
        return f": cannot be read again ({error.strerror})"
    return f", {size} bytes, SHA-256 {found.hexdigest()}"


def command_line() -> str:
    """The command that this process was started with, as one would type it."""
    program = Path(sys.argv[0])
    name = f"python -m {program.parent.name}" if program.name == "__main__.py" else shlex.quote(program.name)
    return " ".join([name, *map(shlex.quote, sys.argv[1:])])


def _blocks(file: Path) -> Iterator[bytes]:
    with file.open("rb") as stream:
        while block := stream.read(1 << 20):
            yield block


def _versions() -> Iterable[str]:
    for package in PACKAGES:
        try:
            yield f"{package} {version(package)}"
        except PackageNotFoundError:
            yield f"{package} from its sources"
