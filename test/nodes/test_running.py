"""A signal while a node is made, heard or not."""

import signal
import sys
import time
from contextlib import suppress

import pytest

from pierburg_ros.nodes.graph.running import made


@pytest.fixture(autouse=True)
def _handlers():
    numbers = signal.SIGINT, signal.SIGTERM, signal.SIGALRM
    before = [signal.getsignal(number) for number in numbers]
    hook = sys.unraisablehook
    yield
    for number, handler in zip(numbers, before, strict=True):
        signal.signal(number, handler)
    sys.unraisablehook = hook


def _swallowing():
    with suppress(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def _swallowing_and_going_on():
    _swallowing()
    return "a node"


def _swallowing_and_waiting():
    _swallowing()
    time.sleep(60.0)
    return "a node"


def _ending_in_an_error_of_its_own():
    try:
        signal.raise_signal(signal.SIGTERM)
    except KeyboardInterrupt:
        raise RuntimeError("no compiled object yet") from None


@pytest.mark.parametrize("make", [_swallowing_and_going_on, _swallowing_and_waiting, _ending_in_an_error_of_its_own])
def test_a_signal_ends_the_making_though_it_is_swallowed(make):
    assert made(make) is None


def test_a_node_that_is_left_alone_is_made():
    assert made(lambda: "a node") == "a node"


def test_an_error_of_the_node_itself_goes_on():
    def make():
        raise RuntimeError("no such actuator")

    with pytest.raises(RuntimeError, match="no such actuator"):
        made(make)
