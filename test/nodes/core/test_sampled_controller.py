"""One duty a sample: schedule, repeats, restarts."""

import numpy as np
import pytest

from pierburg_ros.control import Controller, Setpoints, read_setpoint_file
from pierburg_ros.nodes.core.commanded_duty import CommandedDuty
from pierburg_ros.nodes.core.sampled_controller import SampledController

PERIOD = 2_000_000  # ns


@pytest.fixture
def loop():
    return SampledController(Controller(), Setpoints(initial=0.5))


def test_it_is_the_control_law_with_the_time_between_samples(loop):
    law = Controller()
    voltages = 0.42 + 0.5 * np.random.default_rng(1).random(50)
    expected = [law.step(0.5, voltage, 0.002) for voltage in voltages]
    assert [loop.duty(voltage, 10**9 + k * PERIOD) for k, voltage in enumerate(voltages)] == expected


def test_the_same_time_again_repeats_the_duty_and_moves_nothing(loop):
    reference = SampledController(Controller(), Setpoints(initial=0.5))
    for tick in range(1, 20):
        duty = loop.duty(0.6, tick * PERIOD)
        assert loop.duty(0.6, tick * PERIOD) == duty
        assert reference.duty(0.6, tick * PERIOD) == duty


def test_time_that_runs_back_starts_anew(loop):
    first = [loop.duty(0.6, tick * PERIOD) for tick in range(1, 20)]
    assert [loop.duty(0.6, tick * PERIOD) for tick in range(1, 20)] == first


def test_a_schedule_counts_from_the_first_sample_and_yields_to_later_writers(loop, tmp_path):
    file = tmp_path / "setpoints.csv"
    file.write_text("time,setpoint\n0,0.2\n0.01,0.8\n")
    loop.schedule = read_setpoint_file(file)
    start = 7 * 10**9
    loop.duty(0.6, start)
    assert loop.setpoints.active == 0.2
    loop.setpoints.offer(0.3)
    loop.duty(0.6, start + PERIOD)
    assert loop.setpoints.active == 0.3
    loop.duty(0.6, start + 5 * PERIOD)
    assert loop.setpoints.active == 0.8


def test_disabled_is_duty_zero_even_on_a_repeat(loop):
    loop.duty(0.6, PERIOD)
    loop.controller.enable(False)
    assert loop.duty(0.6, PERIOD) == 0.0
    assert loop.duty(0.6, 2 * PERIOD) == 0.0


def test_an_interruption_keeps_the_schedules_time(loop, tmp_path):
    file = tmp_path / "setpoints.csv"
    file.write_text("time,setpoint\n0,0.2\n0.01,0.8\n")
    loop.schedule = read_setpoint_file(file)
    loop.duty(0.6, PERIOD)
    loop.interrupt()
    loop.duty(0.6, 6 * PERIOD)
    assert loop.setpoints.active == 0.8


def test_forwarded_duties_stand_in_the_place_of_the_laws_until_their_sender_is_silent(loop):
    loop.forwarded, loop.command_timeout = CommandedDuty(), 0.05
    assert loop.duty(0.6, PERIOD) == 0.0 and not loop.is_forsaken
    loop.forwarded.offer(0.3)
    assert [loop.duty(0.6, tick * PERIOD) for tick in range(2, 28)] == [0.3] * 26
    assert not loop.is_forsaken
    assert loop.duty(0.6, 28 * PERIOD) == 0.0 and loop.is_forsaken
    loop.forwarded.offer(-0.2)
    assert loop.duty(0.6, 29 * PERIOD) == -0.2 and not loop.is_forsaken
