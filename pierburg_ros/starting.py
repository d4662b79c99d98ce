"""The executables: nodes and commands by name, each of which a signal ends also while it is still being imported.

Nothing else is imported here, and the rest only when the handlers are in place.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from importlib import import_module

NODES = ("plant", "controller", "recorder", "monitor", "serial_driver")
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def __getattr__(name: str) -> Callable[[], None]:
    """What runs the node or the command of this `name`, as `ros2 run pierburg_ros NAME` starts it."""
    if name.startswith("_"):
        raise AttributeError(name)
    return lambda: node(name) if name in NODES else command(name)


def node(name: str) -> None:
    """Run a node; a signal ends it with status 0."""
    until_imported(lambda number: 0)
    import_module(f"pierburg_ros.nodes.{name}").main()


def command(name: str) -> None:
    """Run a command, or all of them where the `name` is pierburg; a signal ends it as shells count them."""
    before = [signal.getsignal(number) for number in SIGNALS]
    until_imported(lambda number: 128 + number)
    application = import_module("pierburg_ros.cli.app")
    for number, handler in zip(SIGNALS, before, strict=True):
        signal.signal(number, handler)
    application.main(sys.argv[1:] if name == "pierburg" else [name, *sys.argv[1:]])


def until_imported(status: Callable[[int], int]) -> None:
    """Let a signal end the process at once with its `status`; there is nothing yet that could be left half done."""
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, _: os._exit(status(number)))
