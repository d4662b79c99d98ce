"""Where compiled kernels are kept between processes.

Numba's disk cache notices a change in a kernel's own file but not in the files of the kernels it calls. Here the
folder carries a digest of every source file that mentions kernels and of the effect declarations they are built
from: editing any of them starts a fresh folder. Numba's own settings stay as they are.
"""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import tempfile
import time
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numba
from numba.core import caching

PACKAGE = Path(__file__).parent
KEPT = 6
"""Cache folders kept besides the one in use, those of other versions that ran last; one takes up to 40 MB."""
IDLE = 86_400.0
"""Time [s] after its opening from which a folder may be removed: a day. A process opens its folder with its first
kernel and calls the others within its first minutes; a day leaves room for a suspended machine. What a process finds
removed all the same is compiled again."""
LOG = logging.getLogger(__name__)


def source_digest(package: Path) -> str:
    """Digest of the sources under `package` that define kernels, independent of where it is installed."""
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(package.rglob("*.py")):
        text = source.read_bytes()
        if b"kernel" in text:
            digest.update(source.relative_to(package).as_posix().encode() + text)
    return digest.hexdigest()[:16]


@cache
def cache_folder(package: Path = PACKAGE) -> Path:
    """Folder for compiled kernels, made if need be: in the user's cache, or a temporary one where that is read-only."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    digest = source_digest(package)
    try:
        return opened(base / "pierburg_ros" / digest)
    except OSError:
        return opened(Path(tempfile.gettempdir()) / f"pierburg_ros-{os.getuid()}" / digest)


def opened(folder: Path) -> Path:
    """`folder`, marked as used just now; a new one takes the place of old ones beside it."""
    new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    os.utime(folder)
    if new:
        prune(folder)
    return folder


def prune(folder: Path) -> None:
    """Remove what other versions have left beside `folder`, but for the `KEPT` that ran last and those not `IDLE`."""
    used = {other: last_use(other) for other in folder.parent.iterdir() if other.is_dir() and other != folder}
    for old in sorted(used, key=used.__getitem__, reverse=True)[KEPT:]:
        if time.time() - used[old] > IDLE:
            shutil.rmtree(old, ignore_errors=True)


def last_use(folder: Path) -> float:
    """When a cache folder was used last [s since 1970]; 0 where another process has just removed it."""
    try:
        return folder.stat().st_mtime
    except FileNotFoundError:
        return 0.0


@cache
def announce() -> None:
    """Log, once in a process, that the wait is for the compiler."""
    LOG.info("compiling the simulator for this machine, once (about 20 s) ...")


@cache
def warn(reason: str) -> None:
    """Log, once for each reason, that the next process has to compile again."""
    LOG.warning("a compiled kernel could not be kept (%s); the next process compiles it again", reason)


class KernelCache(caching.NullCache):
    """Numba's disk cache of one kernel, in our folder; opened when the kernel is first needed."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    @property
    def cache_path(self) -> str:
        """Folder of this kernel's files."""
        return str(self._files.cache_path)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was compiled before for a signature; None, and a line in the log, where it has to be compiled now."""
        try:
            found = self._files.load_overload(sig, target_context)
        except OSError:
            found = None
        if found is None:
            announce()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature, in a folder made anew if it is gone.

        Where that fails (a folder removed while it is written to, or not writable) the log says so and the kernel runs.
        """
        try:
            self._files.save_overload(sig, data)
        except OSError as error:
            warn(error.strerror or str(error))

    def flush(self) -> None:
        """Forget what was compiled."""
        self._files.flush()

    @cached_property
    def _files(self) -> Any:  # Numba's caches declare no types
        files: Any = _Files
        return files(self._function)


class _Locator(caching.UserProvidedCacheLocator):
    """Where the files of a kernel lie: in our folder, with a subfolder for each module."""

    def __init__(self, py_func: Any, py_file: str) -> None:
        self._py_file = py_file
        self._lineno = py_func.__code__.co_firstlineno
        self._cache_path = str(cache_folder() / py_func.__module__)

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> _Locator:
        """The locator of a kernel; there is no other for ours."""
        return cls(py_func, py_file)


class _Implementation(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012  # declared so by Numba


class _Files(caching.FunctionCache):
    _impl_class = _Implementation
