"""Starts the nodes as processes and ends them, on a graph of this machine alone. Knows no ROS."""

from __future__ import annotations

import ctypes
import json
import os
import random
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO

DOMAINS = range(1, 100)
"""ROS domain ids whose ports stay clear of those that Linux hands out itself."""
ON_PARENTS_DEATH = 1
"""PR_SET_PDEATHSIG of prctl(2)."""
END_PATIENCE = 30.0
"""Time [s] that a node has to end after it was told to."""


def free_domain() -> int:
    """A ROS domain id without participants on this machine.

    The first participant of a domain listens on port 7410 + 250 id (DDSI-RTPS, section 9.6.1).
    """
    shuffled = random.SystemRandom().sample(DOMAINS, len(DOMAINS))
    return next(domain for domain in shuffled if is_free(7410 + 250 * domain))


def is_free(port: int) -> bool:
    """Whether nobody listens on a UDP port."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("", port))
        except OSError:
            return False
    return True


def own_graph() -> dict[str, str]:
    """Environment of a graph that nobody else is on and that stays on this machine."""
    return {"ROS_DOMAIN_ID": str(free_domain()), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def start_node(
    name: str, parameters: Mapping[str, object], output: IO[bytes] | int, environment: Mapping[str, str]
) -> subprocess.Popen[bytes]:
    """The process of a node, started with parameters; `output` takes what it prints."""
    code = (
        f"from pierburg_ros.processes import end_with_parent; end_with_parent({os.getpid()});"
        f"from pierburg_ros.nodes.{name} import main; main()"
    )
    command = [sys.executable, "-c", code, "--ros-args", *parameter_arguments(parameters)]
    variables = {**os.environ, **environment}
    return subprocess.Popen(command, env=variables, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)


def end_with_parent(parent: int, told: int = signal.SIGINT) -> None:
    """Have the system send `told` to this process when its parent ends, even by SIGKILL; Linux alone can do so."""
    if sys.platform != "linux":
        return
    ctypes.CDLL(None).prctl(ON_PARENTS_DEATH, told)
    if os.getppid() != parent:
        raise SystemExit  # it has ended before it could be asked for


def parameter_arguments(parameters: Mapping[str, object]) -> list[str]:
    """What sets parameters behind `--ros-args`: JSON is YAML, in which a text such as 1e5 stays a text."""
    return [word for name, value in parameters.items() for word in ("-p", f"{name}:={json.dumps(value, default=str)}")]


def end(process: subprocess.Popen[bytes]) -> int:
    """Exit status of a node that is told to end, by force if it does not."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    try:
        return process.wait(timeout=END_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


@contextmanager
def running(
    nodes: Mapping[str, Mapping[str, object]], log: Path, environment: Mapping[str, str]
) -> Iterator[list[subprocess.Popen[bytes]]]:
    """Nodes by name with their parameters, as processes that end with the block; `log` takes what they print."""
    processes: list[subprocess.Popen[bytes]] = []
    with log.open("wb") as output:
        try:
            for name, parameters in nodes.items():
                processes.append(start_node(name, parameters, output, environment))
            yield processes
        finally:
            for process in reversed(processes):
                end(process)
