"""What it costs to hand a piece of work to a worker and take its result back, and where that ends scaling.

    python benchmarks/spread.py

Processor time of the client, of Dask's scheduler and of its workers for each piece of no work with a result as large as
a recording's report, with one and two workers, then a model of it. Writes docs/developers/measurements.md.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from machine import machine, write_section

from pierburg_ros.executors import ended
from pierburg_ros.fleets.store import Store

PIECES = 400
REPORT = 300_000  # characters of a recording's report
WORKERS = (1, 2, 64, 1000)
PATIENCE = 60.0  # s


def piece(number: int) -> str:
    """A result as large as a report."""
    return "x" * REPORT


def main() -> None:
    """Measure, model, write."""
    local = {jobs: of_machine(jobs) for jobs in (1, 2)}
    cluster = {workers: of_cluster(workers) for workers in (1, 2)}
    kept = keeping()
    client, scheduler, worker = (max(cluster[n][place] for n in cluster) for place in range(3))
    rows = [f"| {jobs} processes | {1e3 * local[jobs]:.2f} | - | - |" for jobs in local]
    rows += [f"| {n} Dask workers | {' | '.join(f'{1e3 * each:.2f}' for each in cluster[n])} |" for n in cluster]
    text = f"""### What spreading costs

Processor time [ms] for each of {PIECES} pieces without any work, whose result has {REPORT // 1000} kB, on
{machine()}:

| workers | client | scheduler | all workers |
|---|---|---|---|
{chr(10).join(rows)}

Keeping the result of a recording on disk costs the client {1e3 * kept:.1f} ms more; a trial of `prove` keeps its own.

The model: client and scheduler each take one piece after another, in processes of their own, so they bear the inverse
of the larger time a second; below that N workers do N over the time of a piece. Not in it, since nothing was measured
beyond two workers: what a network, a shared disk or a scheduler with many connections adds, and how long the last piece
keeps all other workers waiting.

| workers | fleet, 5 s a recording: times as fast | `prove`, 30 s a trial: times as fast | 10,000 such trials [h] |
|---|---|---|---|
{modelled(client + kept, scheduler, worker, client)}

It stops scaling at {5.0 / max(client + kept, scheduler):,.0f} workers for the fleet, where the client takes in results
as fast as they come, and at {30.0 / max(client, scheduler):,.0f} for `prove`, where the scheduler hands out trials as
fast as they end.
"""
    write_section("spread", text)


def modelled(fleet_client: float, scheduler: float, worker: float, client: float) -> str:
    """Rows of what the measured times come to with many workers."""
    rows = []
    for count in WORKERS:
        rates = [
            min(count / (work + worker), 1.0 / max(own, scheduler)) * work
            for work, own in ((5.0, fleet_client), (30.0, client))
        ]
        rows.append(f"| {count:,} | {rates[0]:,.1f} | {rates[1]:,.1f} | {10_000 * 30.0 / rates[1] / 3600.0:.2f} |")
    return "\n".join(rows)


def of_machine(jobs: int) -> float:
    """Processor time [s] of this process for each piece that processes of this machine do."""
    begin = own_time()
    assert len(list(ended(piece, range(PIECES), jobs=jobs))) == PIECES
    return (own_time() - begin) / PIECES


def of_cluster(workers: int) -> tuple[float, float, float]:
    """Processor time [s] of client, scheduler and all workers for each piece."""
    with cluster(workers) as (address, scheduler, processes):
        list(ended(piece, range(2 * workers), scheduler=address))
        begin = [own_time(), time_of(scheduler), sum(map(time_of, processes))]
        assert len(list(ended(piece, range(PIECES), scheduler=address))) == PIECES
        end = [own_time(), time_of(scheduler), sum(map(time_of, processes))]
    client, own, all_workers = ((after - before) / PIECES for before, after in zip(begin, end, strict=True))
    return client, own, all_workers


def keeping() -> float:
    """Processor time [s] for each result that is kept on disk."""
    with tempfile.TemporaryDirectory() as folder:
        store, begin = Store(Path(folder)), own_time()
        for number in range(PIECES):
            store.keep(f"{number}", {"problem": None}, {"report.html": piece(number), "diagnosis.json": "x" * 30_000})
        return (own_time() - begin) / PIECES


@contextmanager
def cluster(workers: int) -> Iterator[tuple[str, int, list[int]]]:
    """A scheduler and workers as processes: its address, its process, theirs."""
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"

        def start(*words: str) -> subprocess.Popen[bytes]:
            line = [sys.executable, "-m", f"distributed.cli.{words[0]}", "--scheduler-file", str(file), *words[1:]]
            return subprocess.Popen(line, env=variables, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        started = [start("dask_scheduler", "--port", "0", "--host", "127.0.0.1", "--no-dashboard")]
        started += [start("dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard") for _ in range(workers)]
        try:
            yield address(file), started[0].pid, [each.pid for each in started[1:]]
        finally:
            for each in started:
                each.kill()
                each.wait()


def address(file: Path) -> str:
    """What a scheduler writes into its file once it listens."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            return str(json.loads(file.read_text())["address"])
        except (FileNotFoundError, json.JSONDecodeError):
            time.sleep(0.1)
    raise TimeoutError("the scheduler did not start")


def own_time() -> float:
    """Processor time [s] of this process."""
    return time.process_time()


def time_of(process: int) -> float:
    """Processor time [s] of another process."""
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    main()
