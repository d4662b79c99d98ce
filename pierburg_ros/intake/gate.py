"""Opens input files, and turns what a library raises on their content into one line."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from pierburg_ros.errors import InputError

LARGEST_TEXT = 1 << 20
"""Bytes of a YAML file at most: the metadata of a recording split into 4,000 files has so many."""
PACKAGE = str(Path(__file__).parents[1]) + os.sep
FAULTS = (NameError, AttributeError, TypeError, AssertionError, ImportError, NotImplementedError)
"""What a mistake in a program raises. From a library it is that library's answer to the input."""
KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


@contextmanager
def reading(path: str | Path, expected: str) -> Iterator[None]:
    """Turn what is raised while `path` is read into one line; a mistake of this package itself is not hidden."""
    try:
        yield
    except InputError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"{path} cannot be read ({reason}), expected {expected}. Check the path.") from error
    except MemoryError as error:
        raise InputError(f"{path} needs more memory than there is, expected {expected}. Give a part of it.") from error
    except Exception as error:
        if is_own_fault(error):
            raise
        reason = f"{type(error).__name__}: {error}"
        raise InputError(f"{path} cannot be read as {expected} ({reason[:150]}). Check or repair it.") from error


def is_own_fault(error: BaseException) -> bool:
    """Whether `error` is a mistake in this package: of that type, and raised by its own code."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    inside = trace is not None and trace.tb_frame.f_code.co_filename.startswith(PACKAGE)
    return inside and isinstance(error, FAULTS)


@contextmanager
def opened(path: str | Path, expected: str) -> Iterator[BinaryIO]:
    """The file at `path`, open for reading; pipes, devices and folders are refused before they are opened.

    A pipe could keep the reader for ever, and a device has no end.
    """
    try:
        refuse_other_kinds(path, os.stat(path), expected)
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as file:
            refuse_other_kinds(path, os.fstat(file.fileno()), expected)
            yield file
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist, expected {expected}. Check the path.") from error


def refuse_other_kinds(path: str | Path, status: os.stat_result, expected: str) -> None:
    """Refuse what is not a regular file."""
    kind = KINDS.get(stat.S_IFMT(status.st_mode))
    if kind is not None:
        raise InputError(f"{path} is {kind}, expected {expected}. Give the path of a file.")


def path_of(given: object, expected: str) -> Path:
    """The path that was `given`; InputError where it is something else, or empty, which would be the present folder."""
    if given == "":
        raise InputError(f"Found an empty path, expected {expected}. Name a file or a folder.")
    if not isinstance(given, (str, os.PathLike)):
        raise InputError(f"Found something of type {type(given).__name__}, expected {expected}. Give one of these.")
    return Path(given)


def text_of(path: str | Path, expected: str) -> str:
    """The text of a small file in UTF-8."""
    with opened(path, expected) as file:
        content = file.read(LARGEST_TEXT + 1)
    if len(content) > LARGEST_TEXT:
        raise InputError(f"{path} has more than {LARGEST_TEXT >> 20} MiB, expected {expected}. Check the path.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is not text in UTF-8 (byte {error.start}), expected {expected}.") from error
