"""Results on disk: whole or not there, whatever ends the run.

A run works in a hidden folder beside its output, or in it where nothing can be moved there from beside, and holds a
lock on it, which the system takes back when the run ends, however it ends. So the next run can tell what a dead one
left from what a living one needs.
"""

from __future__ import annotations

import errno
import fcntl
import hashlib
import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from pierburg_ros.errors import InputError

HIDDEN = ".pierburg-"
LOCK, PARTIAL, COMPLETE = "lock", "partial", "complete"
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""What the system answers where a disk or a quota is full."""


@contextmanager
def output_folder(output: Path) -> Iterator[Path]:
    """A hidden folder whose files appear in `output` when the block ends well, and nowhere when it fails.

    Files of an earlier run keep their place in `output` unless a file of the same name replaces them. A second run
    into the same output is refused.
    """
    target = Path(os.path.abspath(output))
    refuse_unusable(output, target)
    made = [parent for parent in target.parents if not parent.exists()]
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        within = hiding_place(target)
        clear_left(within)
        with claimed(target, within) as hidden:
            (hidden / PARTIAL).mkdir()
            yield hidden / PARTIAL
            with undisturbed():
                os.rename(hidden / PARTIAL, hidden / COMPLETE)
                publish(hidden / COMPLETE, target)
    except OSError as error:
        raise full(output, error) from error
    finally:
        for parent in made:
            with suppress(OSError):
                parent.rmdir()


def refuse_unusable(output: Path, target: Path) -> None:
    """Refuse an output that cannot become a folder of results, before anything is computed."""
    if not target.name:
        raise InputError(f"{output} is the root of the file system, expected a folder of its own for the results.")
    if target.is_symlink() and not target.exists():
        raise InputError(f"{output} is a link that leads nowhere, expected a folder for the results. Remove it.")
    if target.exists() and not target.is_dir():
        raise InputError(f"{output} is a file, expected a folder for the results. Choose another folder.")
    refuse_unwritable(output, target)


def refuse_no_file(output: Path) -> None:
    """Refuse an output that cannot become a file, before anything is computed; a device is written as it is."""
    if output.is_dir():
        raise InputError(f"{output} is a folder, expected a file to write. Add a name.")
    if output.is_file() or not output.exists():
        refuse_unwritable(output, output.absolute().parent)


def refuse_unwritable(output: Path, folder: Path) -> None:
    """Refuse an output where no file can be made in its `folder`, or in the nearest one that is there."""
    present = next(path for path in (folder, *folder.parents) if path.exists())
    try:
        tempfile.TemporaryFile(dir=present).close()  # of /proc the rights alone say yes
    except OSError as error:
        raise InputError(f"{output} cannot be written, since {present} cannot. Choose another place.") from error


def hiding_place(target: Path) -> Path:
    """The folder beside `target`, or `target` itself where nothing can be moved there from beside."""
    beside = target.parent
    movable = os.access(beside, os.W_OK | os.X_OK)
    same_disk = not target.exists() or os.stat(target).st_dev == os.stat(beside).st_dev
    return beside if movable and same_disk else target


def full(output: Path, error: OSError) -> OSError | InputError:
    """What to raise for `error`: one line where the disk is full, else itself."""
    if error.errno not in FULL:
        return error
    return InputError(f"{output}: {error.strerror}; nothing was written. Free some space, or choose another folder.")


@contextmanager
def claimed(target: Path, within: Path) -> Iterator[Path]:
    """The hidden folder of `target`, `within` a folder, empty and held by this run alone; gone after the block."""
    name = os.fsencode(target.relative_to(within))
    hidden = within / f"{HIDDEN}{hashlib.sha256(name).hexdigest()[:16]}"
    lock = taken(hidden)
    if lock is None:
        raise InputError(f"Another run writes into {target}. Wait until it has ended, or choose another folder.")
    try:
        lock.write(name)
        lock.flush()
        yield hidden
    finally:
        with undisturbed():
            shutil.rmtree(hidden, ignore_errors=True)
            lock.close()


def taken(hidden: Path) -> IO[bytes] | None:
    """The lock of a hidden folder, taken; None where a living run has it."""
    while True:
        hidden.mkdir(exist_ok=True)
        try:
            lock = (hidden / LOCK).open("ab+")
        except FileNotFoundError:
            continue  # its run has just ended and removed it
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.close()
            return None
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(lock.fileno()), os.stat(hidden / LOCK)):
                return lock
        lock.close()


def clear_left(parent: Path) -> None:
    """Finish or remove what runs that were killed have left in `parent`."""
    for hidden in parent.glob(f"{HIDDEN}*"):
        lock = taken(hidden)
        if lock is None:
            continue
        lock.seek(0)
        name = os.fsdecode(lock.read())
        if name and (hidden / COMPLETE).is_dir():
            publish(hidden / COMPLETE, parent / Path(name).name)
        shutil.rmtree(hidden, ignore_errors=True)
        lock.close()


def publish(complete: Path, target: Path) -> None:
    """Move results to where they belong: at once where nothing is there, else file by file."""
    if not target.exists():
        os.rename(complete, target)
        return
    for source in sorted(path for path in complete.rglob("*") if path.is_file()):
        place = target / source.relative_to(complete)
        place.parent.mkdir(parents=True, exist_ok=True)
        os.replace(source, place)


def published(path: Path) -> Path:
    """Where a path will lie when the runs that write it have ended; from the present folder if it lies below that.

    A path that no run writes is given back as it is.
    """
    for partial in (path.absolute(), *path.absolute().parents):
        hidden = partial.parent
        if partial.name == PARTIAL and hidden.name.startswith(HIDDEN):
            target = hidden.parent / os.fsdecode((hidden / LOCK).read_bytes())
            place = published(target / path.absolute().relative_to(partial))
            return place.relative_to(Path.cwd()) if place.is_relative_to(Path.cwd()) else place
    return path


@contextmanager
def undisturbed() -> Iterator[None]:
    """Hold back SIGINT and SIGTERM until the block has ended."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def write_whole(path: Path, text: str) -> None:
    """Write a file at once, or not at all; what is no file, such as /dev/stdout, as it is."""
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=f".{path.name}-", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        raise full(path, error) from error
    finally:
        Path(temporary).unlink(missing_ok=True)
