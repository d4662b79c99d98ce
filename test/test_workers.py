"""Work over cores: order, errors, interrupts, and what the threads leave to linear algebra."""

import signal
import subprocess
import sys
import threading
import time

import pytest
from threadpoolctl import threadpool_info

from pierburg_ros.errors import InputError
from pierburg_ros.workers import cores, workers

INTERRUPTED = """
import signal, threading
from pierburg_ros.workers import workers
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs in the background without
def endless(_):
    print("begun", flush=True)
    threading.Event().wait(600.0)
with workers(2) as pool:
    list(pool.map(endless, range(8)))
"""


def test_results_keep_the_order_of_the_items():
    first_may_end = threading.Event()

    def work(item):
        first_may_end.wait(60.0) if item == 0 else first_may_end.set()
        return 10 * item

    with workers(2) as pool:
        assert list(pool.map(work, range(5))) == [0, 10, 20, 30, 40]


@pytest.mark.parametrize("jobs", [1, 3])
def test_as_many_pieces_of_work_run_at_a_time_as_there_are_jobs(jobs):
    met, running, most, lock = threading.Barrier(jobs), set(), [0], threading.Lock()

    def work(item):
        with lock:
            running.add(item)
            most[0] = max(most[0], len(running))
        met.wait(60.0)
        with lock:
            running.discard(item)

    with workers(jobs) as pool:
        list(pool.map(work, range(2 * jobs)))
    assert most[0] == jobs


def test_every_core_works_unless_told_otherwise():
    met = threading.Barrier(cores())
    with workers() as pool:
        threads = pool.map(lambda _: (met.wait(60.0), threading.get_ident())[1], range(cores()))
        assert len(set(threads)) == cores()


def test_an_error_in_the_work_reaches_the_caller_and_what_waited_is_not_begun():
    begun, cancelled = [], threading.Event()

    def work(item):
        begun.append(item)
        if item == 0:
            raise InputError("no good")
        cancelled.wait(60.0)  # the only worker may have gone on to the next item, and gets no further

    with pytest.raises(InputError, match="no good"), workers(1) as pool:
        try:
            list(pool.map(work, range(9)))
        finally:
            cancelled.set()
    assert begun in ([0], [0, 1])


def test_linear_algebra_keeps_to_one_thread_meanwhile():
    def threads(_):
        return [library["num_threads"] for library in threadpool_info()]

    with workers(2) as pool:
        assert all(count == 1 for counts in pool.map(threads, range(4)) for count in counts)


def test_no_thread_is_left_behind():
    with workers(2) as pool:
        names = set(pool.map(lambda _: threading.current_thread(), range(4)))
    assert not any(thread.is_alive() for thread in names)


def test_an_interrupt_ends_the_process_while_work_still_runs():
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline().startswith("begun")
    end = time.monotonic() + 120.0  # the work itself would take ten minutes
    while process.poll() is None and time.monotonic() < end:
        process.send_signal(signal.SIGINT)  # one that comes just before Python begins to wait is seen only later
        time.sleep(0.2)
    process.kill()
    assert process.wait() in (1, -signal.SIGINT)


@pytest.mark.parametrize("jobs", [0, -2])
def test_fewer_than_one_job_is_refused(jobs):
    with pytest.raises(InputError, match=f"jobs is {jobs}; expected 1 or more"), workers(jobs):
        pass


def test_results_that_come_too_late_are_not_waited_for():
    release = threading.Event()
    with workers(1) as pool:
        try:
            with pytest.raises(TimeoutError):
                list(pool.map(lambda _: release.wait(60.0), range(2), timeout=0.01))
        finally:
            release.set()
