"""A ROS graph for one test: nodes as real processes, and an observer inside the test."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rclpy
from rcl_interfaces.srv import GetParameters, SetParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import QoSProfile

STOP = signal.SIGINT
DEADLINE = 180.0
"""Longest wait for anything [s]; generous, for a machine that does much else."""
LEAVE = 10.0
"""Longest wait for nodes to end, and for the graph to forget them [s]."""

KEPT = 10_000
"""Messages of a topic that wait for the observer: 20 s at 500 Hz, in which a busy machine may not let it run."""


class Graph:
    """Starts nodes under a ROS domain of its own and watches what they publish."""

    def __init__(self, domain: int, folder: Path) -> None:
        self.environment = {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_LOG_DIR": str(folder / "log"),
        }
        self.folder = folder
        self.received: dict[str, list[Any]] = defaultdict(list)
        self.stamps: dict[str, list[dict[str, int]]] = defaultdict(list)
        self._processes: list[subprocess.Popen[str]] = []
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node("observer", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._publishers: dict[str, Any] = {}
        self._subscriptions: list[Any] = []

    def start(self, name: str, *parameters: str, arguments: tuple[str, ...] = ()) -> subprocess.Popen[str]:
        """Start a node with parameters such as `rate:=200.0`; what it publishes is kept for an observer held up."""
        kept = [f"depth:={KEPT}"] if name in ("plant", "controller", "serial_driver") else []
        given = [word for parameter in (*kept, *parameters) for word in ("-p", parameter)]
        code = f"from pierburg_ros.nodes.{name} import main; main()"
        command = [sys.executable, "-c", code, "--ros-args", *given, *arguments]
        return self.run(command)

    def run(self, command: list[str]) -> subprocess.Popen[str]:
        """Start any process on this graph, its output kept for `ended`."""
        process = subprocess.Popen(
            command,
            env=self.environment,
            cwd=self.folder,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        self._processes.append(process)
        return process

    def watch(self, topic: str, kind: type, profile: QoSProfile | int = KEPT) -> list[Any]:
        """The growing list of messages on a topic."""

        def take(message: Any, info: dict[str, int]) -> None:
            self.received[topic].append(message)
            self.stamps[topic].append(info)

        self._subscriptions.append(self.node.create_subscription(kind, topic, take, profile))
        return self.received[topic]

    def until_connected(self) -> None:
        """Serve the observer until every watched topic has a publisher."""
        self.until(lambda: all(s.get_publisher_count() for s in self._subscriptions), "the publishers")

    def publish(self, topic: str, message: Any) -> None:
        """Publish one message, once somebody reads the topic."""
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, 10)
        publisher = self._publishers[topic]
        self.until(lambda: publisher.get_subscription_count() > 0, f"a reader of {topic}")
        publisher.publish(message)

    def until(self, condition: Callable[[], Any], what: str) -> None:
        """Serve the observer until a condition holds."""
        end = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < end, f"waited {DEADLINE:g} s in vain for {what}"
            self._executor.spin_once(timeout_sec=0.05)

    def call(self, kind: type, service: str, request: Any) -> Any:
        """The answer of a service."""
        client = self.node.create_client(kind, service)
        self.until(client.service_is_ready, service)
        future = client.call_async(request)
        self.until(future.done, f"an answer of {service}")
        return future.result()

    def set(self, node: str, **values: Any) -> list[Any]:
        """Results of setting parameters one by one."""
        parameters = [Parameter(n.replace("__", "."), value=v).to_parameter_msg() for n, v in values.items()]
        request = SetParameters.Request(parameters=parameters)
        return list(self.call(SetParameters, f"{node}/set_parameters", request).results)

    def set_together(self, node: str, **values: Any) -> Any:
        """Result of setting parameters all at once."""
        parameters = [Parameter(n.replace("__", "."), value=v).to_parameter_msg() for n, v in values.items()]
        request = SetParametersAtomically.Request(parameters=parameters)
        return self.call(SetParametersAtomically, f"{node}/set_parameters_atomically", request).result

    def get(self, node: str, *names: str) -> list[Any]:
        """Values of parameters."""
        answer = self.call(GetParameters, f"{node}/get_parameters", GetParameters.Request(names=list(names)))
        return [parameter_value_to_python(value) for value in answer.values]

    def ended(self, process: subprocess.Popen[str], by: signal.Signals | None = STOP) -> tuple[int, str]:
        """Exit status and output of a process, after a signal or by itself."""
        if by is not None:
            process.send_signal(by)
        output, _ = process.communicate(timeout=3 * DEADLINE)
        return process.returncode, output

    def __enter__(self) -> Graph:
        return self

    def __exit__(self, *_: object) -> None:
        """Stop every process that is left and leave the graph.

        Nodes that end take leave over DDS. Their leaves are waited for: Fast DDS has crashed on one that arrived
        while the observer itself was being taken down.
        """
        running = [process for process in self._processes if process.poll() is None]
        for process in running:
            process.send_signal(STOP)
        for process in running:
            try:
                process.communicate(timeout=LEAVE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
        end = time.monotonic() + LEAVE
        while set(self.node.get_node_names()) - {self.node.get_name()} and time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.05)
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)
