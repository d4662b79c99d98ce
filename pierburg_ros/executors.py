"""The one place where whole pieces of work are spread over processes: of this machine, or of a Dask cluster.

    for item, result in ended(work, items, jobs=2):
    for item, result in ended(work, items, scheduler="tcp://10.0.0.5:8786"):

`workers` spreads the fits within one diagnosis over threads; here every piece of work is a diagnosis or a trial.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from typing import Any, TypeVar

from pierburg_ros.errors import InputError
from pierburg_ros.processes import end_with_parent
from pierburg_ros.version import source_version
from pierburg_ros.workers import checked_jobs

Item = TypeVar("Item")
Result = TypeVar("Result")

SCHEDULER_PATIENCE = 30.0
"""Time [s] that a scheduler has to answer, and to have its first worker."""
KILLED = "KilledWorker"
"""What Dask calls a piece of work under which several workers have died, one after another."""
REASON = "its process ended before it was done, each time: too little memory, or a fault of a library"
AHEAD = 2
"""Pieces of work for each thread of a cluster that are under way: one waits at the worker while another runs."""


@dataclass(frozen=True)
class Lost:
    """What stands for the result of a piece of work whose process ended under it, again and again when it ran alone."""

    reason: str


def ended(
    work: Callable[[Item], Result], items: Iterable[Item], jobs: int | None = None, scheduler: str | None = None
) -> Iterator[tuple[Item, Result | Lost]]:
    """Each item with what the work on it gives, in the order in which it ends.

    With a `scheduler` (`tcp://host:port`) on the workers of a Dask cluster, else on `jobs` processes of this machine,
    by default one for each core. No more is under way than there are workers, so that memory stays bounded and an
    interrupt leaves little to wait for. A worker that dies costs nothing: its work is done again.
    """
    crew = cluster(scheduler) if scheduler else machine(checked_jobs(jobs))
    with crew as (pool, room):
        yield from _ended(pool, work, iter(items), room)


def _ended(
    pool: Callable[[], Executor], work: Callable[[Item], Result], left: Iterator[Item], room: Callable[[], int]
) -> Iterator[tuple[Item, Result | Lost]]:
    """The results while they come; what was under way when a process died is done again, one after another."""
    under_way: dict[Future[Result], Item] = {}
    suspects: deque[Item] = deque()
    while True:
        if suspects and not under_way:
            yield _alone(pool, work, suspects.popleft())
            continue
        if not suspects:
            for item in islice(left, max(room() - len(under_way), 0)):
                under_way[pool().submit(work, item)] = item
        if not under_way:
            return
        for future in wait(under_way, return_when=FIRST_COMPLETED).done:
            item = under_way.pop(future)
            try:
                yield item, future.result()
            except BrokenProcessPool:
                suspects.append(item)
            except Exception as error:
                if type(error).__name__ != KILLED:
                    raise
                yield item, Lost(REASON)


def _alone(pool: Callable[[], Executor], work: Callable[[Item], Result], item: Item) -> tuple[Item, Result | Lost]:
    """The result of an item by itself, at the second try if need be: before that it may not even have begun."""
    for _ in range(2):
        try:
            return item, pool().submit(work, item).result()
        except BrokenProcessPool:
            continue
    return item, Lost(REASON)


@contextmanager
def machine(jobs: int) -> Iterator[tuple[Callable[[], Executor], Callable[[], int]]]:
    """Processes of this machine: what gives the pool, a new one where it has broken, and how much it takes at once."""
    pools: list[ProcessPoolExecutor] = []

    def pool() -> Executor:
        if not pools or pools[-1]._broken:
            context = multiprocessing.get_context()
            pools.append(ProcessPoolExecutor(jobs, context, finish_when_interrupted))
        return pools[-1]

    try:
        yield pool, lambda: jobs
    finally:
        for each in pools:
            each.shutdown(cancel_futures=True)


@contextmanager
def cluster(scheduler: str) -> Iterator[tuple[Callable[[], Executor], Callable[[], int]]]:
    """The workers of a Dask cluster, with the sources of this machine, or InputError."""
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "A scheduler needs dask, which is not installed. Install it with pip install 'pierburg_ros[fleet]'."
        ) from None
    try:
        client: Any = Client(scheduler, timeout=SCHEDULER_PATIENCE, set_as_default=False)  # type: ignore[no-untyped-call]
        client.wait_for_workers(1, timeout=SCHEDULER_PATIENCE)
    except (OSError, ValueError) as error:
        raise InputError(
            f"{scheduler}: no scheduler with a worker answers ({error or 'time-out'}), expected one as in"
            " tcp://10.0.0.5:8786. Start dask scheduler and dask worker."
        ) from None
    with client:
        check_versions(client.run(source_version))
        executor = client.get_executor(pure=False)
        yield lambda: executor, lambda: AHEAD * max(sum(client.nthreads().values()), 1)
        executor.shutdown(wait=False)


def check_versions(found: dict[str, Any]) -> None:
    """Refuse workers with other sources: their results would belong to another version."""
    own = source_version()
    other = [worker for worker, version in found.items() if version != own]
    if other:
        raise InputError(
            f"{other[0]} has other sources of pierburg_ros than this machine ({found[other[0]]}, here {own}), expected"
            " the same. Install the same version there."
        )


def finish_when_interrupted() -> None:
    """Leave an interrupt from the keyboard to the main process: a worker ends the work under way first.

    A worker that is told to terminate gives its work up, and ends the nodes that it has started; so does one whose
    main process has been killed.
    """
    end_with_parent(os.getppid(), signal.SIGTERM)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
