"""Writes the SROS2 policy of every node from the graph it really has: starts it in each of its ways and looks.

`python sros2/write_policies.py` replaces sros2/*.policy.xml; test/nodes/test_policies.py holds them against the nodes.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import reduce
from pathlib import Path

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Float64

from pierburg_ros.nodes.core.policy import Rights, policy
from pierburg_ros.nodes.graph.rights import DEADLINE, rights_of
from pierburg_ros.processes import end, own_graph, start_node

FOLDER = Path(__file__).parent
DUTIES = "time,duty\n0,0\n600,0\n"
SETPOINTS = "time,setpoint\n0,0\n600,0\n"
WAYS: dict[str, list[dict[str, object]]] = {
    "plant": [{}, {"simulated_time": True}],
    "controller": [{}, {"publish_internals": True, "use_sim_time": True}],
    "recorder": [{"output": "wall.mcap"}, {"output": "simulated.mcap", "use_sim_time": True}],
    "monitor": [{}, {"angle_topic": "hall_voltage", "duty_topic": "duty", "use_sim_time": True}],
    "excitation": [
        {"duty_file": "duty.csv", "patience": 600.0},
        {"setpoint_file": "setpoints.csv", "patience": 600.0, "use_sim_time": True},
    ],
    "serial_driver": [{"port": "/dev/no_such_line"}],
}
"""Nodes, and the parameters with which each has other topics; their policies allow all of these ways."""
BESIDE_ANOTHER = {"controller": "duty"}
"""Nodes that read a topic while another one publishes it, to know whether that one lives."""

PLACED = 30.0
"""Time [s] after which a node on a busy machine has found its place among others. Chosen: it starts in 2 s on an idle
machine, and ties are settled within 10 s; not varied."""


def observed(name: str, folder: Path) -> Rights:
    """Rights of the node `name` over all its ways, each started alone on a graph of its own; `folder` is its own."""
    (folder / "duty.csv").write_text(DUTIES)
    (folder / "setpoints.csv").write_text(SETPOINTS)
    with ExitStack() as graphs:
        observers = [graphs.enter_context(started(name, _with_paths(way, folder))) for way in WAYS[name]]
        if name in BESIDE_ANOTHER:
            observers.append(_beside_another(name, BESIDE_ANOTHER[name], graphs))
        return reduce(Rights.__or__, rights_of(observers, name))


@contextmanager
def started(name: str, parameters: dict[str, object], published: str = "") -> Iterator[Node]:
    """An observer of the node `name`, started with `parameters`; `published` is a topic that the observer offers."""
    graph = own_graph()
    context = Context()
    rclpy.init(context=context, domain_id=int(graph["ROS_DOMAIN_ID"]))
    observer: Node = rclpy.create_node("observer", context=context, enable_rosout=False)
    if published:
        observer.create_publisher(Float64, published, 10)
    process = start_node(name, parameters, subprocess.DEVNULL, graph)
    try:
        yield observer
    finally:
        end(process)
        observer.destroy_node()
        rclpy.shutdown(context=context)


def _beside_another(name: str, topic: str, graphs: ExitStack) -> Node:
    """An observer of the node `name` that offers a `topic` which the node reads; TimeoutError where it never does.

    On a busy machine the node may find itself alone before it has seen the observer. It then reads nothing, and is
    started again.
    """
    until = time.monotonic() + DEADLINE
    while time.monotonic() < until:
        with ExitStack() as graph:
            observer = graph.enter_context(started(name, {}, topic))
            if _has_reader(observer, topic):
                graphs.push(graph.pop_all())
                return observer
    raise TimeoutError(f"nobody read {topic} within {DEADLINE:g} s")


def _has_reader(observer: Node, topic: str) -> bool:
    """Whether a node comes to read a `topic` that the `observer` offers, before it has surely found its place."""
    until = time.monotonic() + PLACED
    while observer.count_subscribers(topic) == 0:
        if time.monotonic() > until:
            return False
        time.sleep(0.1)
    return True


def _with_paths(parameters: dict[str, object], folder: Path) -> dict[str, object]:
    files = {
        key: str(folder / str(value)) for key, value in parameters.items() if key.endswith("_file") or key == "output"
    }
    return {**parameters, **files}


def main() -> None:
    """Write all policies."""
    for name in WAYS:
        with tempfile.TemporaryDirectory() as folder:
            rights = observed(name, Path(folder))
        path = FOLDER / f"{name}.policy.xml"
        path.write_text(policy(name, rights), encoding="utf-8")
        print(path, flush=True)


if __name__ == "__main__":
    main()
