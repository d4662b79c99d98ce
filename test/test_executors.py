"""Work spread over processes: of this machine and of a Dask cluster, some of which die."""

import json
import os
import subprocess
import sys
import time
from functools import partial

import pytest
from support.pieces_of_work import doubled, fatal, slow

from pierburg_ros.errors import InputError
from pierburg_ros.executors import Lost, _alone, ended, machine

PATIENCE = 60.0


def test_every_item_comes_with_its_result():
    assert dict(ended(doubled, range(20), jobs=2)) == {number: 2 * number for number in range(20)}
    assert list(ended(doubled, [], jobs=2)) == []


def test_a_process_that_dies_costs_only_the_work_that_kills_it_again(tmp_path):
    found = dict(ended(partial(fatal, tmp_path), range(8), jobs=2))
    assert isinstance(found.pop(3), Lost)
    assert found == {number: 2 * number for number in range(8) if number != 3}


def test_work_that_waited_when_a_process_died_may_still_kill_its_own_once(tmp_path):
    """Whether 5 has begun when 3 ends a process is chance; by itself it has not."""
    with machine(1) as (pool, _):
        assert _alone(pool, partial(fatal, tmp_path), 5) == (5, 10)
    (tmp_path / "5").unlink()
    assert dict(ended(partial(fatal, tmp_path), [5], jobs=1)) == {5: 10}
    (tmp_path / "5").unlink()
    found = dict(ended(partial(fatal, tmp_path), [3, 5], jobs=2))
    assert isinstance(found[3], Lost)
    assert found[5] == 10


def test_no_more_is_begun_than_there_are_workers(tmp_path):
    begun = []

    def items():
        for number in range(6):
            begun.append(number)
            yield number

    results = ended(doubled, items(), jobs=2)
    next(results)
    assert len(begun) <= 3
    results.close()


def test_a_scheduler_that_is_not_there_is_one_line(monkeypatch):
    pytest.importorskip("distributed", reason="needs dask")
    monkeypatch.setattr("pierburg_ros.executors.SCHEDULER_PATIENCE", 0.5)
    with pytest.raises(InputError, match=r"tcp://127.0.0.1:9: no scheduler with a worker answers"):
        list(ended(doubled, [1], scheduler="tcp://127.0.0.1:9"))


def whole(file):
    """What is in a JSON file; nothing while it is not there or still being written."""
    try:
        return json.loads(file.read_text())
    except (FileNotFoundError, json.JSONDecodeError):
        return None


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers as processes: the scheduler's address, and the workers."""
    pytest.importorskip("distributed", reason="needs dask")
    place = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": "10s"}
    file = tmp_path / "scheduler.json"
    common = {"env": place, "cwd": tmp_path, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}

    def start(*words):
        return subprocess.Popen([sys.executable, "-m", "distributed.cli." + words[0], *words[1:]], **common)

    options = ("--scheduler-file", str(file), "--no-dashboard")
    scheduler = start("dask_scheduler", *options, "--port", "0", "--host", "127.0.0.1")
    workers = [start("dask_worker", *options, "--nthreads", "1", "--no-nanny") for _ in range(2)]
    end = time.monotonic() + PATIENCE
    while not (said := whole(file)) and time.monotonic() < end:
        time.sleep(0.05)
    yield said["address"], workers
    for process in (*workers, scheduler):
        process.kill()
        process.wait()


def test_a_worker_of_a_cluster_that_is_killed_in_the_middle_costs_nothing(cluster, tmp_path):
    address, workers = cluster
    said = tmp_path / "said"
    said.mkdir()
    found = {}
    for number, result in ended(partial(slow, said), range(16), scheduler=address):
        found[number] = result
        helpers = {int(each.name.partition("-")[2]) for each in said.iterdir()}
        if len(helpers) == 2 and workers[0].poll() is None:
            workers[0].kill()
    assert workers[0].poll() is not None
    assert found == {number: 2 * number for number in range(16)}
