"""Results on disk: a folder that is complete or not there."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pierburg_ros.errors import InputError


@contextmanager
def output_folder(output: Path) -> Iterator[Path]:
    """A temporary folder whose files appear in `output` when the block ends well, and nowhere when it fails.

    Files of an earlier run keep their place in `output` unless a file of the same name replaces them.
    """
    if output.exists() and not output.is_dir():
        raise InputError(f"{output} is a file, expected a folder for the results. Choose another folder.")
    present = next(parent for parent in output.resolve().parents if parent.exists())
    folder = Path(tempfile.mkdtemp(prefix=f".{output.name}-", dir=present))
    try:
        yield folder
        output.mkdir(parents=True, exist_ok=True)
        for source in sorted(path for path in folder.rglob("*") if path.is_file()):
            target = output / source.relative_to(folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(source, target)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
