"""Starting a node and ending it cleanly on SIGINT and SIGTERM."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.parameters import LiveNode

TURN = 0.1
"""Longest time [s] until a signal is noticed while nothing else happens."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


def run(make: Callable[[], LiveNode]) -> None:
    """Make the node and serve it until a signal, then let it finish on a graph that is still there.

    What the node cannot start or go on with ends as one line on stderr and exit status 2. A node that was served
    has closed its files and left the graph; the interpreter's own taking down, seconds of it on a busy machine, is
    left out.
    """
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    status = 0
    try:
        for number in SIGNALS:
            signal.signal(number, signal.default_int_handler)
        serve(make())
        rclpy.try_shutdown()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)
    except KeyboardInterrupt:
        pass
    except InputError as error:
        print(" ".join(str(error).split()), file=sys.stderr)
        status = 2
    finally:
        rclpy.try_shutdown()
    raise SystemExit(status)


def serve(node: LiveNode) -> None:
    """Serve a node until it is told to stop; from here on a signal interrupts no callback."""
    for number in SIGNALS:
        signal.signal(number, lambda *_: node.stopping.set())
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        node.begin()
        while not node.stopping.is_set():
            executor.spin_once(timeout_sec=TURN)
    finally:
        node.stopping.set()
        node.close()
        executor.shutdown()
        node.destroy_node()
