"""The one place where work is spread over cores.

Compiled code releases the interpreter lock, so threads suffice. Linear algebra within them keeps to one thread each:
its own threads would fight with ours for the same cores.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, Future, wait
from contextlib import contextmanager
from numbers import Integral
from queue import SimpleQueue
from threading import Thread
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from pierburg_ros.errors import InputError

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")
Task = Callable[[], None]


def cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def one_thread() -> threadpool_limits:
    """While entered, linear algebra keeps to one thread: its arrays are tall and narrow here, and gain nothing by more.

    with one_thread():
        ...
    """
    return threadpool_limits(1)


@contextmanager
def workers(jobs: int | None = None) -> Iterator[Executor]:
    """Threads for `jobs` pieces of work at a time; None: one for each core.

        with workers(jobs) as pool:
            fits = list(pool.map(fit, starts))

    `map` gives results in the order of its items and raises what a piece of work raised; nothing that waited is
    begun then. Work that runs in the pool must not wait for other work of the same pool.
    """
    pool = _Threads(checked_jobs(jobs))
    try:
        with one_thread():
            yield pool
    except BaseException as error:
        # An interrupt waits for nothing; any other error leaves no work behind that still changes something.
        pool.shutdown(wait=isinstance(error, Exception), cancel_futures=True)
        raise
    pool.shutdown()


def checked_jobs(jobs: int | None) -> int:
    """The number of workers that is meant by `jobs`; InputError where it is no whole number, or less than one."""
    if jobs is not None and not (isinstance(jobs, Integral) and jobs >= 1):
        raise InputError(f"jobs is {jobs!r}; expected 1 or more, a whole number. Leave it out to use every core.")
    return jobs or cores()


class _Threads(Executor):
    """An executor whose threads end with the process.

    Those of `concurrent.futures` keep an interrupted command waiting until the last of them has finished.
    """

    def __init__(self, jobs: int) -> None:
        self._tasks: SimpleQueue[tuple[Future[Any], Task] | None] = SimpleQueue()
        self._waiting: set[Future[Any]] = set()
        self._closed = False
        self._threads = [Thread(target=self._work, daemon=True, name=f"worker-{n}") for n in range(jobs)]
        for thread in self._threads:
            thread.start()

    def map(
        self,
        fn: Callable[..., Result],
        *iterables: Iterable[Any],
        timeout: float | None = None,
        chunksize: int = 1,
    ) -> Iterator[Result]:
        """Results in the order of the items; TimeoutError after `timeout` [s]."""
        end = None if timeout is None else time.monotonic() + timeout
        futures = [self.submit(fn, *items) for items in zip(*iterables, strict=False)]
        return self._in_time(futures, end)

    def _in_time(self, futures: Sequence[Future[Result]], end: float | None) -> Iterator[Result]:
        """The results one by one; those that are not asked for any more are cancelled."""
        try:
            for future in futures:
                wait([future], None if end is None else max(end - time.monotonic(), 0.0))
                if not future.done():
                    raise TimeoutError
                yield future.result()
        finally:
            for future in futures:
                future.cancel()

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """The future result of `function`."""
        if self._closed:
            raise RuntimeError("These workers have been dismissed.")
        future: Future[Result] = Future()
        self._waiting.add(future)
        self._tasks.put((future, lambda: future.set_result(function(*args, **kwargs))))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Dismiss the threads once their work is done, or the work that waits is cancelled."""
        self._closed = True
        if cancel_futures:
            for future in tuple(self._waiting):
                future.cancel()
        for _ in self._threads:
            self._tasks.put(None)
        for thread in self._threads if wait else ():
            thread.join()

    def _work(self) -> None:
        while (task := self._tasks.get()) is not None:
            future, run = task
            self._waiting.discard(future)
            if not future.set_running_or_notify_cancel():
                continue
            try:
                run()
            except BaseException as error:
                future.set_exception(error)
