"""The part of `pierburg prove` that works on real recordings."""

from __future__ import annotations

import math
import signal
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.cli.console.progress import Step, Tell, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.models import chosen_model
from pierburg_ros.cli.options.recordings import topics_of
from pierburg_ros.errors import InputError
from pierburg_ros.library.reading import read
from pierburg_ros.pages.listing import Listing
from pierburg_ros.proof.real import document, run
from pierburg_ros.proof.real.document import Run, answered, headline
from pierburg_ros.proof.real.machine import Machine, machine_in
from pierburg_ros.proof.real.strengths import LEVELS

RealOption = Annotated[
    Path | None,
    typer.Option(metavar="FOLDER", help="Put known effects into the real recordings of one machine in this folder."),
]
LevelOption = Annotated[
    list[str] | None,
    typer.Option(help=f"With --real: only this strength ({', '.join(LEVELS)}); may be repeated."),
]


def machine(
    folder: Path,
    actuator: str | None,
    model: Path | None,
    signals: Path | None,
    topic: Sequence[str] | None,
    time: str | None,
) -> Machine:
    """The machine whose recordings lie in `folder`, read as the other commands read them; says what is left out."""
    described = chosen_model(model, actuator)
    topics = topics_of(topic)
    found = machine_in(
        folder,
        described,
        lambda path: read(path, time=time, topics=topics, signals=signals, actuator=described.actuator),
        known=model is not None,
    )
    for why in found.left_out:
        terminal(stderr=True).print(f"Left out: {why}", soft_wrap=True)
    return found


def prove(
    machine: Machine,
    output: Path,
    only: Sequence[str],
    levels: Sequence[str],
    most: int | None,
    jobs: int | None,
    scheduler: str | None,
    budget: str,
    docs: Path | None,
) -> list[dict[str, Any]]:
    """Conduct the trials, write what they came to, and give their results."""
    plan = run.planned(machine, only, levels, most)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with progress() as show:
        show(Step("the models of other recordings"))
        reporter = Reporter(show)
        results = run.prove(output, plan, efforts(budget), workers=jobs, scheduler=scheduler, report=reporter)
    if not results:
        raise InputError(f"No trial has ended in {output}. Run the same command again to go on.")
    done = Run(results, plan)
    document.write(done, output, docs)
    terminal().print(summary(done), f"Results in {output}: proof-real.md, results.jsonl")
    return results


def efforts(budget: str) -> float:
    """Usual efforts for each diagnosis; InputError for seconds, by which its results would depend on the machine."""
    given = Budget.of(budget or USUAL_BUDGET)
    if math.isfinite(given.seconds):
        raise InputError(f"--budget is {budget}; expected usual efforts such as 2 or 0.5 for a run that is measured.")
    return given.efforts


class Reporter:
    """Shows how far a run is, and how many of the effects that were put in are named."""

    def __init__(self, show: Tell) -> None:
        self.show = show
        self.put_in = self.named = 0

    def __call__(self, done: int, total: int, last: dict[str, Any] | None) -> None:
        if last is not None and last["true"] is not None:
            self.put_in += 1
            self.named += last["named"]
        what = "" if last is None else f"{last['name']}: {answered(last)}"
        self.show(Step("real recordings", done, total, f"{self.named} of {self.put_in} named", what=what))


def summary(done: Run) -> Listing:
    """The headline figures."""
    rows = [(name, str(share)) for name, share in headline(done).items()]
    return Listing(
        ("figure", "count (95 % Wilson interval)"), rows, f"Effects put into real recordings, n = {len(done.results)}"
    )
