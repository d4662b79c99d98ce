"""How often a command sent once arrives, as `ros2 topic pub --once` sends it, with all nodes up.

python benchmarks/once.py --times 100 writes its section of the measurements; --no-write only prints. A sender is a
process of its own that waits for one reader, sends, stays for a while (`STAYS`) and ends.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import rclpy
from graph import load
from machine import machine, write_section
from rcl_interfaces.msg import ParameterEvent
from std_msgs.msg import Float64

from pierburg_ros.cli.demo import compile_kernels
from pierburg_ros.processes import own_graph, running

SENDER = """
import sys, time, rclpy
from {package}.msg import {kind} as Kind
rclpy.init()
node = rclpy.create_node("once")
publisher = node.create_publisher(Kind, "{topic}", 10)
while publisher.get_subscription_count() < 1:
    time.sleep(0.1)
message = Kind()
{fill}
publisher.publish(message)
time.sleep({stay})
node.destroy_node()
rclpy.shutdown()
"""
RESISTANCE = """
message.name = "armature_resistance"
message.value.type = 3
message.value.double_value = {}
"""
PATIENCE = 5.0  # s that a command gets to show its effect


STAYS = (0.1, 2.0)
"""Times [s] that a sender stays after its message: what `ros2 topic pub --once` does, and with `--keep-alive 2`."""


def sent(topic: str, package: str, kind: str, fill: str, stay: float) -> None:
    """Send one message from a process of its own that ends `stay` [s] after it."""
    code = SENDER.format(topic=topic, package=package, kind=kind, fill=fill, stay=stay)
    subprocess.run([sys.executable, "-c", code], check=True)


def arrived(node: rclpy.node.Node, has_come: Callable[[], bool]) -> bool:
    """Whether the effect of a command shows in time."""
    end = time.monotonic() + PATIENCE
    while not has_come() and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.02)
    return has_come()


def run(times: int, busy: int, stay: float) -> tuple[int, int]:
    """How many of so many setpoints and parameters, each sent once by a sender that stays for `stay` [s], arrived."""
    graph = own_graph()
    os.environ.update(graph)
    active: list[float] = []
    changed: list[float] = []
    rclpy.init()
    node = rclpy.create_node("observer")
    node.create_subscription(Float64, "active_setpoint", lambda m: active.append(m.data), 1000)
    node.create_subscription(
        ParameterEvent,
        "/parameter_events",
        lambda m: changed.extend(p.value.double_value for p in m.changed_parameters),
        1000,
    )
    with tempfile.TemporaryDirectory() as name:
        nodes = {"recorder": {"output": Path(name) / "run.mcap"}, "plant": {}, "controller": {}}
        with load(busy), running(nodes, Path(name) / "log", graph):
            arrived(node, lambda: bool(active))
            setpoints = parameters = 0
            for count in range(1, times + 1):
                setpoint, resistance = count * 0.01, 4.0 + count * 0.01
                sent("/setpoints", "std_msgs", "Float64", f"message.data = {setpoint!r}", stay)
                setpoints += arrived(node, lambda value=setpoint: value in active)
                sent("/plant/set_parameter", "rcl_interfaces", "Parameter", RESISTANCE.format(resistance), stay)
                parameters += arrived(node, lambda value=resistance: value in changed)
    rclpy.shutdown()
    return setpoints, parameters


def main() -> None:
    """Measure, and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=100)
    parser.add_argument("--busy", type=int, default=0, help="busy processes beside")
    parser.add_argument("--note", default="", help="what else ran on the machine")
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    compile_kernels()
    others = os.getloadavg()[0]
    rows = ""
    for stay in STAYS:
        setpoints, parameters = run(options.times, options.busy, stay)
        rows += f"| `/setpoints` | {stay} s | {setpoints} of {options.times} |\n"
        rows += f"| `/plant/set_parameter` | {stay} s | {parameters} of {options.times} |\n"
    text = (
        "## Commands sent once\n\n"
        "Each by a process that waits for one reader, sends, stays for a while and ends, as `ros2 topic pub --once`"
        " does, which stays for 0.1 s unless `--keep-alive` says otherwise; plant, controller and recorder run, with"
        f" {options.busy} busy processes beside. {machine()}. Load average before: {others:.1f}. {options.note}\n\n"
        f"| topic | stays | arrived of sent |\n|---|---|---|\n{rows}\n"
        "Made by `python benchmarks/once.py`."
    )
    print(text)
    if options.write:
        write_section("once", text)


if __name__ == "__main__":
    main()
