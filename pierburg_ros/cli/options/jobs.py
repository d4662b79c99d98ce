"""The options with which a command that computes in parallel is told how much at a time, and where."""

from __future__ import annotations

from typing import Annotated

import typer

JobsOption = Annotated[
    int | None, typer.Option(min=1, show_default=False, help="Pieces of work at a time; default: one for each core.")
]
SchedulerOption = Annotated[
    str | None,
    typer.Option(
        metavar="tcp://HOST:PORT",
        show_default=False,
        help="Work on this Dask cluster in place of processes of this machine.",
    ),
]
