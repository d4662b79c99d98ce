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

SIGNAL_NOTICED = 0.1
"""Longest time [s] until a signal is noticed while nothing else happens."""

SIGNAL_AGAIN = 0.5
"""Time [s] after which a signal that was not heard is raised again: well within the 5 s in which a node has to end."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


def run(make: Callable[[], LiveNode]) -> NoReturn:
    """Make the node and serve it until a signal, then let it finish on a graph that is still there.

    What the node cannot start or go on with ends as one line on stderr and exit status 2.
    """
    status = 0
    try:
        join()
        node = made(make)
        if node is not None:
            serve(node)
    except KeyboardInterrupt:  # between its making and its serving
        pass
    except InputError as error:
        print(error, file=sys.stderr)
        status = 2
    finally:
        rclpy.try_shutdown()
    leave(status)


def join() -> None:
    """Join the graph with the arguments of the command line; InputError where ROS does not understand them."""
    try:
        rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        said = str(error).removeprefix("failed to initialize rcl: ").split(", at /")[0]
        raise InputError(f"{said}. See 'ros2 run --help' for what may follow --ros-args.") from error


def made(make: Callable[[], LiveNode]) -> LiveNode | None:
    """The node, or none where a signal came while it was made.

    A signal is raised again every `SIGNAL_AGAIN` until it is noticed: the compiler's callbacks swallow what is raised
    within them, or end in an error of their own.
    """
    told = False

    def interrupt(*_: object) -> None:
        nonlocal told
        told = True
        sys.unraisablehook = lambda _: None  # what a callback swallows is told as a traceback otherwise
        signal.setitimer(signal.ITIMER_REAL, SIGNAL_AGAIN)
        raise KeyboardInterrupt

    for number in (*SIGNALS, signal.SIGALRM):
        signal.signal(number, interrupt)
    node = None
    try:
        node = make()
    except (Exception, KeyboardInterrupt):
        if not told:
            raise
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, signal.SIG_IGN)
    return None if told else node


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
            executor.spin_once(timeout_sec=SIGNAL_NOTICED)
