"""The options with which a command that computes is told how much at a time, where, and for how long."""

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
BudgetOption = Annotated[
    str,
    typer.Option(
        metavar="EFFORT",
        help="What may be simulated, in usual efforts (2, 0.5): the same on every machine. Or at most so many seconds"
        " of this one (60s). Then the best verdict yet is given.",
    ),
]
"""As text, for `Budget.of`."""
