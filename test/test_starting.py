"""Executables as they are started, and a signal that comes while they are still being imported."""

import signal
import subprocess
import sys

import pytest

IMPORTING = """
import sys, time
class Slow:
    def find_spec(name, path, target=None):
        if name == sys.argv[2]:
            print("importing", flush=True)
            time.sleep(600)
sys.meta_path.insert(0, Slow)
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs in the background without
import pierburg_ros.starting
getattr(pierburg_ros.starting, sys.argv[1])()
"""


@pytest.mark.parametrize(
    ("name", "module", "number", "status"),
    [
        ("plant", "pierburg_ros.nodes.plant", signal.SIGINT, 0),
        ("controller", "pierburg_ros.control", signal.SIGTERM, 0),
        ("replay", "typer", signal.SIGINT, 130),
        ("pierburg", "typer", signal.SIGTERM, 143),
    ],
)
def test_a_signal_while_importing_ends_without_a_word(name, module, number, status):
    process = subprocess.Popen(
        [sys.executable, "-c", IMPORTING, name, module], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert process.stdout.readline() == "importing\n"
    process.send_signal(number)
    output, _ = process.communicate(timeout=120)
    assert (process.returncode, output) == (status, "")


def test_only_names_of_executables_are_looked_up():
    import pierburg_ros.starting

    with pytest.raises(AttributeError):
        _ = pierburg_ros.starting.__wrapped__
