"""The graph of a test, under a domain that nobody else on this machine uses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from pierburg_ros.cli.demo import compile_kernels
from pierburg_ros.processes import free_domain


@pytest.fixture(scope="session", autouse=True)
def compiled() -> None:
    """Kernels in the cache, so that no test waits for a node that compiles them."""
    compile_kernels()


@pytest.fixture
def domain() -> int:
    """A ROS domain id without participants on this machine."""
    return free_domain()


@pytest.fixture
def graph(domain: int, tmp_path: Path) -> Iterator[object]:
    """An empty graph; its nodes end with the test."""
    pytest.importorskip("rclpy")
    from support.ros_graph import Graph

    with Graph(domain, tmp_path) as graph:
        yield graph
