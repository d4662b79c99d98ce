"""Starting a node and ending it cleanly on SIGINT and SIGTERM."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Callable
from contextlib import ExitStack
from typing import NoReturn

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.graph.parameters import LiveNode

TURN = 0.1
"""Longest time [s] until a signal is noticed while nothing else happens."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


def run(make: Callable[[], LiveNode]) -> NoReturn:
    """Make the node and serve it until a signal, then let it finish on a graph that is still there.

    What the node cannot start or go on with ends as one line on stderr and exit status 2.
    """
    rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    status = 0
    try:
        for number in SIGNALS:
            signal.signal(number, signal.default_int_handler)
        serve(make())
    except KeyboardInterrupt:
        pass
    except InputError as error:
        print(" ".join(str(error).split()), file=sys.stderr)
        status = 2
    finally:
        rclpy.try_shutdown()
    leave(status)


def leave(status: int) -> NoReturn:
    """End the process, the node having closed its files.

    Taking down an interpreter with this many modules takes seconds on a busy machine, and nothing needs it. A node
    that was interrupted in its making leaves the graph with its last reference.
    """
    gc.collect()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def serve(node: LiveNode) -> None:
    """Serve a node until it is told to stop; from here on a signal interrupts no callback."""
    for number in SIGNALS:
        signal.signal(number, lambda *_: node.stopping.set())
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    with ExitStack() as leaving:  # in the reverse order, each whatever the one before it raises
        leaving.callback(node.destroy_node)
        leaving.callback(executor.shutdown)
        leaving.callback(node.close)
        leaving.callback(node.stopping.set)
        node.begin()
        while not node.stopping.is_set():
            executor.spin_once(timeout_sec=TURN)
