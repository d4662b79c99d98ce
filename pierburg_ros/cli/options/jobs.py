"""The options with which a command that computes is told how much at a time, where, and for how long."""

from __future__ import annotations

from typing import Annotated

import typer

from pierburg_ros.deadline import USUAL_BUDGET

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
    float | None,
    typer.Option(
        min=1.0,
        show_default=f"{USUAL_BUDGET:g}",
        help="Stop a diagnosis after this many seconds of an idle machine, with the best verdict yet.",
    ),
]
