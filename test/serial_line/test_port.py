"""The line itself: what is not there, what is no line, and a plug that is pulled."""

import os
import time

import pytest
from support.simulated_device import DeviceOnPty, SimulatedDevice

from pierburg_ros.errors import InputError
from pierburg_ros.serial_line.link import Link
from pierburg_ros.serial_line.port import Port, Unplugged


def test_a_device_on_a_line_obeys_and_answers():
    line, link, received = DeviceOnPty(SimulatedDevice()), Link(), []
    with Port(line.path, 115200) as port:
        end = time.monotonic() + 60.0
        while not any(each.state.duty > 0.0 for each in received) and time.monotonic() < end:
            received += link.take(port.read(0.1), time.time_ns())
            port.write(link.command(0.2, 5.0))
    line.unplug()
    assert received[-1].state.duty == pytest.approx(0.2)


def test_a_pulled_plug_is_told():
    line = DeviceOnPty(SimulatedDevice())
    with Port(line.path, 115200) as port:
        port.read(1.0)
        line.unplug()
        with pytest.raises(Unplugged):
            for _ in range(1000):
                port.read(0.01)


def test_a_line_that_is_not_there_may_come_later():
    with pytest.raises(Unplugged, match="No such file"):
        Port("/dev/no_such_line", 115200)


def test_a_file_is_no_line(tmp_path):
    path = tmp_path / "file"
    path.touch()
    with pytest.raises(InputError, match="is no serial line"):
        Port(str(path), 115200)


def test_a_speed_that_no_line_has_is_refused():
    with pytest.raises(InputError, match="12345 baud"):
        Port(os.devnull, 12345)
