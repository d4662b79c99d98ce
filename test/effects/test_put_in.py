"""Effects put into channels, against closed forms and SciPy, and against the simulator that has the effect."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import signal

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.effects.put_in import CannotPutIn, Channels, Series
from pierburg_ros.plant import Inputs, Model, simulate

TIME = np.arange(400) * 0.005
ANGLE = 0.6 * np.sin(3.0 * TIME) + 0.2 * np.sin(11.0 * TIME)
DUTY = np.where(TIME < 1.0, 0.3, -0.2) * (TIME > 0.2)
VALVE = Model.nominal(read_actuator("pierburg"))


def channels(**changes):
    """Channels of a position sensor."""
    whole = Channels(Series(TIME, ANGLE), Series(TIME, DUTY), None, 0.0, 1.0, np.pi / 2)
    return replace(whole, **changes)


def put(effect, given, **values):
    """The channels with an effect."""
    return EFFECT[effect].put_in(given, values)


def test_a_lag_is_that_of_scipy():
    tau = 0.03
    after = put("sensor_lag", channels(), time_constant=tau).measured.values
    _, expected, _ = signal.lsim(signal.lti([1.0], [tau, 1.0]), ANGLE, TIME, X0=[tau * ANGLE[0]])
    assert after == pytest.approx(expected, abs=1e-9)


def test_a_play_follows_its_closed_form():
    up_and_down = np.interp(TIME, [0.0, 1.0, TIME[-1]], [0.0, 1.0, 0.0])
    after = put("sensor_hysteresis", channels(measured=Series(TIME, up_and_down)), width=0.1).measured.values
    expected = np.where(TIME <= 1.0, np.maximum(up_and_down - 0.05, 0.0), np.minimum(up_and_down + 0.05, 0.95))
    assert after == pytest.approx(expected, abs=1e-12)


def test_a_play_in_volts_has_the_width_of_its_angle():
    volts = Series(TIME, 0.42 + 2.61 * ANGLE)
    after = put("sensor_hysteresis", channels(measured=volts, zero=0.42, per_radian=2.61), width=0.1).measured.values
    assert (after - 0.42) / 2.61 == pytest.approx(put("sensor_hysteresis", channels(), width=0.1).measured.values)


def test_a_bend_is_nothing_at_the_ends_and_most_between():
    volts = Series(TIME[:3], np.array([0.42, 2.47, 4.52]))
    bent = channels(measured=volts, zero=0.42, per_radian=4.1 / (np.pi / 2))
    after = put("sensor_nonlinearity", bent, amplitude=0.02, half_waves=1.0).measured.values
    assert after == pytest.approx([0.42, 2.47 + 0.02 * 4.1, 4.52])


def test_a_converter_rounds_to_the_nearest_step():
    after = put("sensor_quantization", channels(), step=0.05).measured.values
    assert np.max(np.abs(after - ANGLE)) <= 0.025 + 1e-12
    assert after / 0.05 == pytest.approx(np.round(after / 0.05))


def test_a_delay_logs_the_command_earlier():
    after = put("input_delay", channels(), delay=0.02)
    late = np.searchsorted(after.command.time + 0.02, TIME + 1e-9, side="right") - 1
    assert after.command.values[late] == pytest.approx(DUTY)
    assert after.measured.values is ANGLE


def test_less_its_dead_band_the_duty_is_the_one_recorded():
    after = put("pwm_deadband", channels(), width=0.05).command.values
    assert np.sign(after) * np.maximum(np.abs(after) - 0.05, 0.0) == pytest.approx(DUTY)


def test_a_duty_that_reaches_1_keeps_the_voltage_at_the_motor():
    full, supply = Series(TIME, np.clip(5.0 * DUTY, -1.0, 1.0)), Series(TIME, np.full(TIME.size, 7.0))
    after = put("pwm_deadband", channels(command=full, supply_voltage=supply), width=0.05)
    effective = np.sign(after.command.values) * np.maximum(np.abs(after.command.values) - 0.05, 0.0)
    assert np.max(np.abs(after.command.values)) <= 1.0
    assert effective * after.supply_voltage.values == pytest.approx(full.values * 7.0)
    with pytest.raises(CannotPutIn, match="no supply voltage was recorded"):
        put("pwm_deadband", channels(command=full), width=0.05)


@pytest.mark.parametrize("effect", [e.id for e in EFFECTS if e.put_in is not None and e.rounds is None])
def test_the_machine_with_the_effect_would_have_made_the_changed_recording(effect):
    """A valve simulated without the effect, and then changed, is the valve simulated with it under the changed duty."""
    declared = EFFECT[effect]
    size = declared.parameter(declared.strength[0]).expected(VALVE.scales)[1]
    values = {name: declared.typical.get(name, 0.0) for name in declared.names} | {declared.strength[0]: size}
    time = np.arange(1500) * 0.002
    duty = 0.3 + 0.25 * np.sin(2.0 * time) * np.sign(np.sin(5.0 * time))
    before = simulate(VALVE, Inputs(time, duty), time)
    given = Channels(Series(time, before), Series(time, duty), None, 0.42, 4.1 / (np.pi / 2), np.pi / 2)
    after = declared.put_in(given, values)
    model = VALVE.with_values({f"{effect}.{name}": value for name, value in values.items()})
    unlike, made = (simulate(model, Inputs(s.command.time, s.command.values), time) for s in (given, after))
    # between two samples the changed one follows a straight line
    assert np.sqrt(np.mean((made - after.measured.values) ** 2)) < 1e-3 * np.ptp(before)
    assert np.sqrt(np.mean((unlike - before) ** 2)) > 3e-3 * np.ptp(before)
