"""Pieces of work that worker processes can import, some of which kill the process that does them."""

import os
import signal
import time
from pathlib import Path


def doubled(number):
    return 2 * number


def fatal(folder, number):
    """Twice the number; 3 kills its process whenever it runs, 5 the first time only."""
    once = Path(folder) / f"{number}"
    first = not once.exists()
    once.touch()
    if number == 3 or (number == 5 and first):
        os.kill(os.getpid(), signal.SIGKILL)
    return 2 * number


def slow(folder, number):
    """Twice the number, after a while; says in a file who does it."""
    (Path(folder) / f"{number}-{os.getpid()}").touch()
    time.sleep(0.3)
    return 2 * number
