"""Ways to pace a node at 500 Hz: an rclpy timer, a loop around spin_once, and a thread beside the executor.

python benchmarks/pacing.py writes its section of docs/developers/measurements.md. An echo process answers every tick.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import numpy as np
import rclpy
from graph import load, quantiles
from machine import machine, write_section
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from std_msgs.msg import Float64

from pierburg_ros.nodes.core.pacing import Pacer
from pierburg_ros.nodes.plant import SWITCH_INTERVAL
from pierburg_ros.processes import end, own_graph

PERIOD = 0.002  # s
SETTLING = 1.0  # s


class Ticker:
    """A node that sends the time at every tick and takes the echoes."""

    def __init__(self) -> None:
        self.node = rclpy.create_node("ticker")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.publisher = self.node.create_publisher(Float64, "tick", 10)
        self.node.create_subscription(Float64, "echo", self.on_echo, 10)
        self.ticks: list[float] = []
        self.trips: list[float] = []

    def tick(self) -> None:
        """Send the time."""
        self.ticks.append(time.monotonic())
        self.publisher.publish(Float64(data=self.ticks[-1]))

    def on_echo(self, message: Float64) -> None:
        """Note how long a tick was on its way."""
        self.trips.append(time.monotonic() - message.data)

    def until_answered(self) -> None:
        """Wait for the echo process."""
        while not self.trips:
            self.tick()
            self.executor.spin_once(timeout_sec=0.05)
        time.sleep(SETTLING)
        self.ticks, self.trips = [], []


def by_timer(ticker: Ticker, stop: float) -> None:
    """An rclpy timer."""
    ticker.node.create_timer(PERIOD, ticker.tick)
    while time.monotonic() < stop:
        ticker.executor.spin_once(timeout_sec=0.1)


def by_loop(ticker: Ticker, stop: float) -> None:
    """One thread that serves the executor until the next deadline."""

    def serve(left: float) -> None:
        deadline = time.monotonic() + left
        while (remaining := deadline - time.monotonic()) > 0.0:
            ticker.executor.spin_once(timeout_sec=remaining)

    pacer = Pacer(PERIOD, sleep=serve)
    while time.monotonic() < stop:
        pacer.wait()
        ticker.tick()


def by_thread(ticker: Ticker, stop: float) -> None:
    """A thread that sleeps until the next deadline, beside the executor's."""

    def ticks() -> None:
        pacer = Pacer(PERIOD)
        while time.monotonic() < stop:
            pacer.wait()
            ticker.tick()

    with ThreadPoolExecutor(1) as pool:
        done = pool.submit(ticks)
        while not done.done():
            ticker.executor.spin_once(timeout_sec=0.1)


def by_eager_thread(ticker: Ticker, stop: float) -> None:
    """The same with a shorter turn of Python's threads."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(SWITCH_INTERVAL)
    by_thread(ticker, stop)
    sys.setswitchinterval(usual)


WAYS: dict[str, Callable[[Ticker, float], None]] = {
    "rclpy timer": by_timer,
    "loop around spin_once": by_loop,
    "thread": by_thread,
    f"thread, turns of {SWITCH_INTERVAL * 1e3:g} ms (chosen)": by_eager_thread,
}


def measured(name: str, duration: float, busy: int) -> str:
    """One row of the table."""
    ticker = Ticker()
    ticker.until_answered()
    with load(busy):
        start = time.monotonic()
        WAYS[name](ticker, start + duration)
        missed = round((time.monotonic() - start) / PERIOD) - len(ticker.ticks)
    ticker.node.destroy_node()
    intervals, trips = np.diff(ticker.ticks) * 1e3, np.array(ticker.trips) * 1e3
    return f"| {name} | {busy} | {missed / duration * PERIOD:.1%} | {quantiles(intervals)} | {quantiles(trips)} |"


def echo() -> None:
    """The other process: sends back what it gets."""
    rclpy.init()
    node = rclpy.create_node("echo")
    publisher = node.create_publisher(Float64, "echo", 10)
    node.create_subscription(Float64, "tick", publisher.publish, 10)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


def main() -> None:
    """Measure every way, idle and loaded, and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--duration", type=float, default=20.0, help="length of each run [s]")
    parser.add_argument("--note", default="", help="what else ran on the machine")
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    os.environ.update(own_graph())
    other = subprocess.Popen([sys.executable, "-c", "from pacing import echo; echo()"], cwd=os.path.dirname(__file__))
    rclpy.init()
    rows = [measured(name, options.duration, busy) for busy in (0, os.cpu_count() or 1) for name in WAYS]
    rclpy.shutdown()
    end(other)
    text = "\n".join(
        [
            f"## Pacing\n\nTicks at 500 Hz for {options.duration:.0f} s, answered by a second process. {machine()}."
            f" {options.note}\n",
            "| way | busy processes beside | ticks missed | interval p50 / p99 / max | round trip p50 / p99 / max |",
            "|---|---|---|---|---|",
            *rows,
            "\nMade by `python benchmarks/pacing.py`.",
        ]
    )
    print(text)
    if options.write:
        write_section("pacing", text)


if __name__ == "__main__":
    main()
