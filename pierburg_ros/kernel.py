"""The one place that configures Numba.

Numba's disk cache notices a change in a kernel's own file but not in the files of the kernels it calls, so the
cache folder carries a digest of every source file that mentions kernels and of the effect declarations they are
built from: editing any of them starts a fresh folder.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar

import numba
from numba.core import event

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

KEPT = 6
"""Cache folders kept besides the one in use: those of other versions that ran last."""


def source_digest(package: Path) -> str:
    """Digest of the sources under `package` that define kernels, independent of where it is installed."""
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(package.rglob("*.py")):
        text = source.read_bytes()
        if b"kernel" in text:
            digest.update(source.relative_to(package).as_posix().encode() + text)
    return digest.hexdigest()[:16]


def cache_folder(package: Path) -> Path:
    """Folder for compiled kernels: the user's cache folder, or a temporary one where that cannot be written."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = base / "pierburg_ros" / source_digest(package)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)
    except OSError:
        folder = Path(tempfile.gettempdir()) / f"pierburg_ros-{os.getuid()}" / folder.name
        folder.mkdir(parents=True, exist_ok=True)
    return folder


def prune(folder: Path) -> None:
    """Remove what older versions have left beside `folder`, but for the `KEPT` that ran last."""
    others = [other for other in folder.parent.iterdir() if other.is_dir() and other != folder]
    others.sort(key=lambda other: other.stat().st_mtime, reverse=True)
    for old in others[KEPT:]:
        shutil.rmtree(old, ignore_errors=True)


class _Announcement(event.Listener):
    """Says, once, that the wait is for the compiler; a kernel found in the cache is no event."""

    def __init__(self) -> None:
        self._made = False

    def on_start(self, event: event.Event) -> None:
        ours = event.data["dispatcher"].py_func.__module__.startswith("pierburg_ros")
        if ours and not self._made:
            self._made = True
            print("compiling the simulator for this machine, once (about 20 s) ...", file=sys.stderr, flush=True)

    def on_end(self, event: event.Event) -> None:
        """The wait is over when the command goes on."""


CACHE = cache_folder(Path(__file__).parent)
prune(CACHE)
numba.config.CACHE_DIR = str(CACHE)  # type: ignore[attr-defined]  # set by name, not declared
event.register("numba:compile", _Announcement())  # type: ignore[no-untyped-call]


def kernel(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Compile `function` without the interpreter: cached on disk, releasing the interpreter lock.

    Numba infers the types of each call; a kernel's docstring says what its arguments are, with units.
    """
    compiled: Callable[Arguments, Result] = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    return compiled
