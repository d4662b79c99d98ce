"""The live graph: plant, controller and recorder at 500 Hz, idle and on a machine with all cores busy.

python benchmarks/graph.py --duration 600 writes its section of docs/developers/measurements.md; --no-write only prints.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from machine import machine, write_section
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from pierburg_ros.cli.demo import compile_kernels
from pierburg_ros.nodes.core.depth import KEPT_MESSAGES
from pierburg_ros.processes import own_graph, running

RATE = 500.0  # Hz
SETTLING = 5.0  # s, until all nodes know each other; not counted
BACKLOG = 10  # samples the controller's reader keeps; older ones are dropped unanswered
TOPICS = ("/hall_voltage", "/applied_duty", "/joint_states", "/duty")
STEPS = (0.35, 1.2, 0.6, 0.0)  # rad, five seconds each


@dataclass(frozen=True)
class Measured:
    """Figures of one run: texts by row of the table."""

    rows: dict[str, str]


@contextmanager
def load(processes: int) -> Iterator[None]:
    """Processes that do nothing but compute."""
    busy = [multiprocessing.Process(target=compute, daemon=True) for _ in range(processes)]
    for process in busy:
        process.start()
    yield
    for process in busy:
        process.kill()
        process.join()


def compute() -> None:
    """Compute for ever."""
    while True:
        pass


def run(duration: float, busy: int) -> Measured:
    """Figures of the three processes over `duration` [s] with `busy` other processes computing."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        recording, setpoints = folder / "run.mcap", folder / "setpoints.csv"
        times = np.arange(0.0, duration + 2 * SETTLING, 5.0)
        rows = [f"{t},{STEPS[k % len(STEPS)]}" for k, t in enumerate(times)]
        setpoints.write_text("\n".join(["time,setpoint", *rows]) + "\n")
        nodes = {"recorder": {"output": recording}, "plant": {"depth": KEPT_MESSAGES}, "controller": {}}
        nodes["controller"] = {"depth": KEPT_MESSAGES, "setpoint_file": setpoints}
        with load(busy), running(nodes, folder / "log", own_graph()) as processes:
            time.sleep(SETTLING)
            before, start = usage(processes), time.time_ns()
            time.sleep(duration)
            after, end = usage(processes), time.time_ns()
        consumption = {
            f"{name}: processor, memory": f"{(b[0] - a[0]) / duration:.0%}, {b[1]:.0f} MiB"
            for name, a, b in zip(nodes, before, after, strict=True)
        }
        return Measured({**signals(recording, start, end), **consumption})


def usage(processes: list[subprocess.Popen[bytes]]) -> list[tuple[float, float]]:
    """Processor time [s] and resident memory [MiB] of each process so far."""
    found = []
    for process in processes:
        folder = Path("/proc") / str(process.pid)
        fields = (folder / "stat").read_text().rsplit(")", 1)[1].split()
        ticks = int(fields[11]) + int(fields[12])
        pages = int((folder / "statm").read_text().split()[1])
        found.append((ticks / os.sysconf("SC_CLK_TCK"), pages * os.sysconf("SC_PAGE_SIZE") / 2**20))
    return found


def signals(recording: Path, start: int, end: int) -> dict[str, str]:
    """Rows on messages, ticks and round trips between `start` and `end` [ns]."""
    times = messages(recording, start, end)
    sent = {topic: found[:, 0] for topic, found in times.items()}
    lost = sum(int(numbers[-1] - numbers[0]) + 1 - numbers.size for numbers in sent.values())
    total = sum(numbers.size for numbers in sent.values())
    interval = np.diff(times["/hall_voltage"][:, 1]) * 1e-6
    expected = (end - start) * 1e-9 * RATE
    trips, unanswered = round_trips(times["/hall_voltage"], times["/duty"])
    return {
        "messages recorded on the four signals": f"{total}",
        "messages lost, by sequence": f"{lost}",
        "ticks skipped": f"{skipped(recording, start, end)} of {expected:.0f}",
        "tick interval p50 / p99 / max": quantiles(interval),
        "round trip plant, controller, plant p50 / p99 / max": quantiles(trips * 1e-6),
        "samples without a duty of their own": f"{unanswered}",
    }


def messages(recording: Path, start: int, end: int) -> dict[str, np.ndarray]:
    """Number, publish time and arrival [ns] of every message on the four signals, shape (messages, 3)."""
    found: dict[str, list[tuple[int, int, int]]] = {topic: [] for topic in TOPICS}
    with recording.open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages(topics=list(TOPICS)):
            if start <= message.publish_time < end:
                found[channel.topic].append((message.sequence, message.publish_time, message.log_time))
    return {topic: np.array(sorted(entries), dtype=np.int64) for topic, entries in found.items()}


def round_trips(samples: np.ndarray, duties: np.ndarray) -> tuple[np.ndarray, int]:
    """Times [ns] from a sample's publication to the arrival of its duty, and the samples that got none.

    The controller answers samples in order, so a duty belongs to the next unanswered sample that was sent before it;
    more than a reader's depth behind, the samples in between were dropped.
    """
    trips, answered, first = [], -1, None
    newest = np.searchsorted(samples[:, 1], duties[:, 1]) - 1
    for duty, latest in zip(duties, newest, strict=True):
        if latest <= answered:
            continue
        answered = answered + 1 if first is not None and latest - answered <= BACKLOG else int(latest)
        first = answered if first is None else first
        trips.append(duty[2] - samples[answered, 1])
    return np.array(trips), answered - (first or 0) + 1 - len(trips)


def skipped(recording: Path, start: int, end: int) -> int:
    """Ticks that the plant says it left out between its first and last report."""
    counts = []
    with AnyReader([recording]) as reader:
        chosen = [c for c in reader.connections if c.topic == "/diagnostics"]
        for connection, _, data in reader.messages(chosen, start=start, stop=end):
            for status in reader.deserialize(data, connection.msgtype).status:
                counts += [int(v.value) for v in status.values if v.key == "skipped_ticks"]
    return counts[-1] - counts[0]


def quantiles(values: np.ndarray) -> str:
    """Median, 99th percentile and maximum of times [ms]."""
    median, high, most = np.percentile(values, [50, 99, 100])
    return f"{median:.2f} / {high:.2f} / {most:.1f} ms"


def table(idle: Measured, loaded: Measured, busy: int) -> str:
    """The two runs side by side."""
    lines = [f"| | idle | with {busy} busy processes beside |", "|---|---|---|"]
    lines += [f"| {row} | {idle.rows[row]} | {loaded.rows[row]} |" for row in idle.rows]
    return "\n".join(lines)


def main() -> None:
    """Measure both runs and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=600.0, help="length of each run [s]")
    parser.add_argument("--busy", type=int, default=os.cpu_count() or 1, help="busy processes in the second run")
    parser.add_argument("--note", default="", help="what else ran on the machine")
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    compile_kernels()
    others = os.getloadavg()[0]
    idle = run(options.duration, 0)
    loaded = run(options.duration, options.busy)
    text = (
        "## Live graph\n\n"
        f"Plant, controller and recorder as three processes at {RATE:.0f} Hz, {options.duration:.0f} s each; setpoints "
        f"from 0 to 1.2 rad every 5 s. {machine()}. Load average of the machine before the first run: {others:.1f}."
        f" {options.note}\n\n{table(idle, loaded, options.busy)}\n\n"
        "Times are the senders' stamps and the arrivals at a process beside, on one clock. Made by "
        "`python benchmarks/graph.py`."
    )
    print(text)
    if options.write:
        write_section("live graph", text)


if __name__ == "__main__":
    main()
