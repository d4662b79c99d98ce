"""`pierburg run`: the nodes for those without `ros2 run`."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.errors import InputError, near
from pierburg_ros.starting import NODES

DISCOVERY = "ROS_AUTOMATIC_DISCOVERY_RANGE"
"""How far nodes look for others: LOCALHOST, SUBNET or OFF."""


def run(
    context: typer.Context,
    node: Annotated[str, typer.Argument(help=f"One of {', '.join(NODES)}; --ros-args and more may follow.")],
    output: Annotated[
        Path | None, typer.Option(help="File or folder of the recorder; short for --ros-args -p output:=...")
    ] = None,
) -> dict[str, str]:
    """Start a node; it runs until SIGINT or SIGTERM.

    Everything behind the node's name goes to ROS. Only this machine sees the node;
    ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET opens it to the network.
    """
    if node not in NODES:
        raise InputError(f"There is no node {node!r}; expected one of {', '.join(NODES)}.{near(node, NODES)}")
    require_ros()
    os.environ.setdefault(DISCOVERY, "LOCALHOST")
    sys.argv = [node, *context.args, *recorded_into(node, output)]
    import_module(f"pierburg_ros.nodes.{node}").main()
    return {"node": node}


def recorded_into(node: str, output: Path | None) -> list[str]:
    """The ROS arguments with which the recorder writes to `output`; InputError for a node that writes nothing."""
    if output is None:
        return []
    if node != "recorder":
        raise InputError(f"Found --output with {node}, which writes no file; expected it with recorder. Leave it out.")
    return ["--ros-args", "-p", f"output:={output}"]


def require_ros() -> None:
    """Raise InputError where the ROS client library is not installed."""
    if find_spec("rclpy") is None:
        raise InputError(
            "ROS 2 was not found (no module rclpy). Install its wheels with pip install 'pierburg_ros[ros]', "
            "or source an installed ROS 2 Jazzy."
        )
