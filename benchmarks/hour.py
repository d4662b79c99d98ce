"""A long run at 500 Hz: messages lost by sequence, memory at start, middle and end, ticks skipped.

python benchmarks/hour.py --duration 3600 --case idle writes its section of the measurements, one for each case;
--no-write only prints.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from pathlib import Path

from graph import SETTLING, load, skipped, usage
from machine import machine, write_section
from stalls import lost_of_sent

from pierburg_ros.cli.demo import compile_kernels
from pierburg_ros.nodes.core.depth import KEPT_MESSAGES
from pierburg_ros.processes import own_graph, running

STEPS = (0.35, 1.2, 0.6, 0.0)  # rad, five seconds each


def run(duration: float, busy: int) -> dict[str, str]:
    """Figures of plant, controller and recorder over `duration` [s] beside `busy` processes, by row of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        recording, setpoints = folder / "run.mcap", folder / "setpoints.csv"
        times = [5.0 * count for count in range(int(duration / 5.0) + 10)]
        rows = [f"{time},{STEPS[count % len(STEPS)]}" for count, time in enumerate(times)]
        setpoints.write_text("\n".join(["time,setpoint", *rows]) + "\n")
        nodes = {"recorder": {"output": recording}, "plant": {"depth": KEPT_MESSAGES}, "controller": {}}
        nodes["controller"] = {"depth": KEPT_MESSAGES, "setpoint_file": setpoints}
        with load(busy), running(nodes, folder / "log", own_graph()) as processes:
            time.sleep(SETTLING)
            looks, start = [usage(processes)], time.time_ns()
            for _ in range(2):
                time.sleep(duration / 2.0)
                looks.append(usage(processes))
            end = time.time_ns()
        lost, sent = lost_of_sent(recording)
        memory = {
            f"{node}: memory at start, middle and end": " / ".join(f"{look[place][1]:.1f}" for look in looks) + " MiB"
            for place, node in enumerate(nodes)
        }
        processor = {
            f"{node}: processor": f"{(looks[-1][place][0] - looks[0][place][0]) / duration:.0%}"
            for place, node in enumerate(nodes)
        }
        ticks = f"{skipped(recording, start, end)} of {duration * 500.0:.0f}"
        return {"lost of sent": f"{lost} of {sent}", "ticks skipped": ticks, **memory, **processor}


def main() -> None:
    """Measure, and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=3600.0, help="length of the run [s]")
    parser.add_argument("--case", default="idle", help="what the machine does meanwhile: name of the section")
    parser.add_argument("--busy", type=int, default=0, help="busy processes beside")
    parser.add_argument("--note", default="", help="what else ran on the machine")
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    compile_kernels()
    others = os.getloadavg()[0]
    found = run(options.duration, options.busy)
    rows = "\n".join(f"| {name} | {value} |" for name, value in found.items())
    text = (
        f"## A long run, {options.case} machine\n\n"
        f"Plant, controller and recorder as three processes at 500 Hz for {options.duration:.0f} s in wall time,"
        f" {options.busy} busy processes beside, one run. {machine()}. Load average before: {others:.1f}."
        f" {options.note}\n\n| | |\n|---|---|\n{rows}\n\nMade by `python benchmarks/hour.py --case {options.case}`."
    )
    print(text)
    if options.write:
        write_section(f"hour {options.case}", text)


if __name__ == "__main__":
    main()
