"""The option with which a command writes for the Rerun viewer as well."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def _writable(path: Path | None) -> Path | None:
    """The file of `--rerun`, refused before any work is done where it cannot be written."""
    if path is not None:
        from pierburg_ros.viewers.rerun_overlay import check_rerun

        check_rerun()
    return path


RerunOption = Annotated[
    Path | None,
    typer.Option("--rerun", metavar="FILE.rrd", callback=_writable, help="Also write a file for the Rerun viewer."),
]
