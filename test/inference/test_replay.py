"""What a model would have measured: the plain simulation, begun anew where the input was not known."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.inference.replay import parts_of, resimulated
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.loss import Loss

PENDULUM = Model.nominal(read_actuator("ak80"))


def without_duty(whole: Recording, start: float, end: float) -> Recording:
    """The recording without the duties in a span [s]."""
    lost = Loss("duty", None, whole.command.time.size, ((start, end),))
    kept = (whole.command.time <= start) | (whole.command.time >= end)
    kept[0] = True
    duty = Channel(whole.command.time[kept], whole.command.values[kept])
    return replace(whole, command=duty, losses=(lost,))


def test_what_begins_at_rest_is_the_plain_simulation():
    measured = recording({"armature_resistance": 5.0})
    kept, simulated = resimulated(NOMINAL, measured)
    duty = measured.command
    assert kept.time.size == measured.time.size
    np.testing.assert_allclose(simulated, simulate(NOMINAL, Inputs(duty.time, duty.values), measured.time), atol=1e-9)


def test_an_angle_in_the_place_of_a_hall_voltage_is_replayed_in_radians():
    volts = recording({})
    angle = (volts.measured - 0.42) / 4.1 * np.pi / 2
    turned = replace(volts, quantity="position", measured=angle)
    (_, one), (_, other) = resimulated(NOMINAL, volts), resimulated(NOMINAL, turned)
    np.testing.assert_allclose(other, (one - 0.42) / 4.1 * np.pi / 2, atol=1e-9)


def test_after_an_unknown_input_the_simulation_begins_anew():
    """Without the duties of 2 s the shaft is elsewhere than a duty that is held would take it."""
    lossy = without_duty(recording({}), 9.0, 11.0)
    kept, simulated = resimulated(NOMINAL, lossy)
    own = NOMINAL.scales.time
    assert not np.any((kept.time > 9.0) & (kept.time <= 11.0 + own))
    assert kept.time[-1] == lossy.time[-1]
    left = kept.measured - simulated
    assert np.sqrt(np.mean(left[kept.time < 9.0] ** 2)) < 1.05 * NOISE
    assert np.sqrt(np.mean(left[kept.time > 11.0] ** 2)) < 1.5 * NOISE
    held = simulate(NOMINAL, Inputs(lossy.command.time, lossy.command.values), kept.time)
    after = (kept.time > 11.0 + own) & (kept.time < 11.5 + own)
    assert np.sqrt(np.mean((kept.measured - held)[after] ** 2)) > 3.0 * NOISE


def test_single_messages_that_are_missing_are_no_loss_where_nothing_changed():
    """Every fiftieth duty, a message in 0.1 s, is missing in a duty that is held for 0.6 s."""
    whole = recording({})
    ends = whole.time[50::50]
    lost = Loss("duty", ends.size, whole.command.time.size, tuple((end - 0.004, end) for end in ends.tolist()))
    kept, _ = resimulated(NOMINAL, replace(whole, losses=(lost,)))
    assert kept.time.size > 0.7 * whole.time.size


def test_an_input_that_is_never_known_is_refused():
    lossy = without_duty(recording({}), -1.0, 100.0)
    with pytest.raises(InputError, match="no 16 samples in a row under a known duty"):
        parts_of(lossy, NOMINAL.actuator)


def test_what_forgets_nothing_is_pulled_to_the_recording():
    """A torque off by a tenth takes a pendulum far away in ten seconds, in its own time little."""
    time = np.arange(0.0, 10.0, 0.004)
    torque = 2.0 * np.interp(time, np.linspace(0.0, 10.0, 25), np.random.default_rng(2).standard_normal(25))
    angle = simulate(PENDULUM, Inputs(time, torque), time)
    swing = Recording("swing", "position", time, angle, Channel(time, torque), input="torque")
    wrong = PENDULUM.with_values({"torque_scale": 1.1})
    _, pulled = resimulated(wrong, swing)
    free = simulate(wrong, Inputs(time, torque), time)
    errors = [float(np.sqrt(np.mean((each - angle) ** 2))) for each in (pulled, free)]
    assert errors[0] < 0.2 * errors[1]
    _, right = resimulated(PENDULUM, swing)
    assert np.sqrt(np.mean((right - angle) ** 2)) < 0.05 * errors[0]
