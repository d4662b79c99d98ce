"""What the recorder loses when a process gets no processor: each one stopped in turn, and all beside busy ones.

python benchmarks/stalls.py writes its section of docs/developers/measurements.md; --no-write only prints.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
from graph import load
from machine import machine, write_section
from mcap.reader import make_reader

from pierburg_ros.cli.demo import compile_kernels
from pierburg_ros.nodes.core.depth import KEPT_MESSAGES
from pierburg_ros.processes import own_graph, running

NODES = ("plant", "controller", "recorder")
TOPICS = ("/hall_voltage", "/applied_duty", "/joint_states", "/duty", "/clock")
STOPS = (0.2, 1.0, 5.0)  # s
FLOWING = 60_000  # bytes of a recording in which messages flow
QUIET = 2.0  # s between two stops, and after the last one


def stopped(process: subprocess.Popen[bytes], duration: float) -> None:
    """Take the processor away from a process for `duration` [s]."""
    process.send_signal(signal.SIGSTOP)
    time.sleep(duration)
    process.send_signal(signal.SIGCONT)


def run(victim: str | None, stops: tuple[float, ...], busy: int, time_kind: str) -> tuple[int, int]:
    """Messages lost and sent on the signals while `victim` is stopped, or for 20 s beside `busy` processes."""
    is_simulated = time_kind != "wall"
    common = {"use_sim_time": is_simulated}
    nodes: dict[str, dict[str, object]] = {
        "recorder": common,
        "plant": {"depth": KEPT_MESSAGES, "simulated_time": is_simulated, "lockstep": time_kind == "lockstep"},
        "controller": {
            **common,
            "depth": KEPT_MESSAGES,
            "setpoint": 0.8,
            **({"hall_timeout": 0.0} if is_simulated else {}),
        },
    }
    with tempfile.TemporaryDirectory() as name:
        recording = Path(name) / "run.mcap"
        nodes["recorder"] = {**common, "output": recording}
        with load(busy), running(nodes, Path(name) / "log", own_graph()) as processes:
            by_name = dict(zip(nodes, processes, strict=True))
            while not recording.exists() or recording.stat().st_size < FLOWING:
                time.sleep(0.1)
            for duration in stops:
                stopped(by_name[victim], duration)
                time.sleep(QUIET)
            time.sleep(0.0 if stops else 20.0)
        return lost_of_sent(recording)


def lost_of_sent(recording: Path) -> tuple[int, int]:
    """Messages missing in the numbers of the signals, and messages sent between their first and last one."""
    numbers: dict[str, list[int]] = defaultdict(list)
    with recording.open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages(topics=list(TOPICS)):
            numbers[channel.topic].append(message.sequence)
    spans = {topic: np.array(sorted(found)) for topic, found in numbers.items()}
    sent = sum(int(found[-1] - found[0]) + 1 for found in spans.values())
    return sent - sum(found.size for found in spans.values()), sent


def main() -> None:
    """Measure every case and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--busy", type=int, default=8, help="busy processes in the rows that have them")
    parser.add_argument("--stops", type=float, nargs="+", default=STOPS, help="durations of the stops [s]")
    parser.add_argument("--note", default="", help="what else ran on the machine")
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    compile_kernels()
    stops = tuple(options.stops)
    told = ", ".join(f"{duration:g}" for duration in stops)
    rows = ["| taken away | time | busy processes beside | lost of sent |", "|---|---|---|---|"]
    others = os.getloadavg()[0]
    cases: list[tuple[str | None, int]] = [(victim, 0) for victim in NODES]
    cases += [(None, options.busy), *((victim, options.busy) for victim in NODES)]
    for kind in ("wall", "simulated", "lockstep"):
        for victim, busy in cases:
            if kind == "lockstep" and victim == "controller" and max(stops) >= 5.0:
                continue  # a run in lockstep ends after 5 s without a duty
            results = [run(victim, stops if victim else (), busy, kind) for _ in range(options.repeats)]
            lost, sent = (sum(column) for column in zip(*results, strict=True))
            what = f"{victim}, for {told} s" if victim else "nothing, 20 s"
            rows.append(f"| {what} | {kind} | {busy} | {lost} of {sent} |")
            print(rows[-1], flush=True)
    text = (
        "## Recording\n\n"
        "Plant, controller and recorder at 500 Hz as three processes; one of them gets no processor for a while"
        f" (SIGSTOP, then SIGCONT), {options.repeats} run(s) a row. Lost: missing in the senders' numbers on"
        f" {', '.join(TOPICS)}. {machine()}. Load average before: {others:.1f}. {options.note}\n\n"
        + "\n".join(rows)
        + "\n\nMade by `python benchmarks/stalls.py`."
    )
    print(text)
    if options.write:
        write_section("recording", text)


if __name__ == "__main__":
    main()
