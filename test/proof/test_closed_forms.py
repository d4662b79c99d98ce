"""The textbook formulation against solutions that can be written down, one for each piece of physics."""

from math import asinh, exp, pi, sin

import numpy as np
import pytest

from pierburg_ros.proof.formulation import NOMINAL, simulate_textbook

SPAN = 4.1 / (pi / 2)  # V/rad
CONSTANT = NOMINAL["gear_ratio"] * NOMINAL["torque_constant"]  # N.m/A
BRAKING = CONSTANT**2 / NOMINAL["armature_resistance"]  # N.m.s/rad
TORQUE = CONSTANT * NOMINAL["supply_voltage"] / NOMINAL["armature_resistance"]  # N.m at duty 1
STIFFNESS, PRELOAD, DRY = (NOMINAL[n] for n in ("spring_stiffness", "spring_preload", "coulomb_friction"))
HALF_MILLIVOLT = 0.0005 / SPAN  # rad


def angle(values, time, duty, **options):
    """Measured angle [rad] of the textbook valve."""
    return (simulate_textbook(values, time, duty, **options) - 0.42) / SPAN


def times(duration, rate=1000.0):
    return np.arange(round(duration * rate)) / rate


def test_opening_follows_the_first_order_solution():
    time = times(2.0)
    found = angle({}, time, np.full(time.size, 0.22))
    settled = (TORQUE * 0.22 - PRELOAD - DRY) / STIFFNESS
    expected = settled * (1.0 - np.exp(-STIFFNESS * time / BRAKING))
    assert np.abs(found - expected).max() < HALF_MILLIVOLT


def test_a_stuck_shaft_does_not_creep():
    time = times(30.0)
    held = (PRELOAD + STIFFNESS * 0.8 + 0.9 * DRY) / TORQUE
    found = angle({}, time, np.full(time.size, held), initial_angle=0.8)
    assert np.ptp(found) == 0.0


def test_both_stops_hold_and_are_left_without_delay():
    time = times(3.0)
    duty = np.where(time < 1.0, 1.0, np.where(time < 2.0, -0.3, 0.3))
    found = angle({}, time, duty)
    assert found[990] == pytest.approx(pi / 2, abs=1e-12)
    assert found[1990] == pytest.approx(0.0, abs=1e-12)
    expected = (TORQUE * 0.3 - PRELOAD - DRY) / STIFFNESS * (1.0 - exp(-STIFFNESS * 0.1 / BRAKING))
    assert found[2100] == pytest.approx(expected, abs=HALF_MILLIVOLT)


def test_an_open_bridge_does_not_brake():
    time = times(0.05)
    duty = np.zeros(time.size)
    free, braked = (angle({}, time, duty, initial_angle=1.0, enabled=duty + on) for on in (0.0, 1.0))
    assert free[20] == pytest.approx(0.0, abs=1e-12)
    assert braked[20] > 0.9


def test_viscous_friction_is_more_resistance_and_torque_constant():
    time = times(4.0)
    duty = np.where(time < 2.0, 0.24, 0.05)
    factor = 1.0 + 0.03 / BRAKING
    tied = {name: NOMINAL[name] * factor for name in ("armature_resistance", "torque_constant")}
    viscous = angle({"viscous_friction.coefficient": 0.03}, time, duty)
    assert np.abs(viscous - angle(tied, time, duty)).max() < HALF_MILLIVOLT


def test_static_friction_holds_up_to_breakaway():
    time = times(1.0)
    values = {"static_friction.breakaway_torque": 0.28, "static_friction.stribeck_velocity": 0.1}
    below, above = (angle(values, time, np.full(time.size, (PRELOAD + 0.28 + step) / TORQUE)) for step in (-1e-4, 1e-4))
    assert below.max() == 0.0
    assert above[-1] > 1e-4


def test_a_falling_friction_curve_ends_where_the_branch_does():
    """The slide stops at the velocity where motor braking no longer makes up for the falling friction."""
    breakaway, scale = 0.28, 0.1
    time = times(4.0)
    values = {"static_friction.breakaway_torque": breakaway, "static_friction.stribeck_velocity": scale}
    duty = 0.24
    found = angle(values, time, np.full(time.size, duty))
    speed = np.linspace(0.0, 1.0, 200001)
    needed = BRAKING * speed + DRY + (breakaway - DRY) * np.exp(-((speed / scale) ** 2))
    stops_at = (TORQUE * duty - PRELOAD - needed[speed > 0.02].min()) / STIFFNESS
    assert found[-1] == pytest.approx(stops_at, abs=0.001)


def test_the_bristle_gives_way_like_a_spring():
    time = times(0.5)
    values = {"presliding.stiffness": 20.0, "presliding.damping": 0.02}
    duty = np.zeros(time.size) + (PRELOAD + STIFFNESS * 0.8) / TORQUE
    duty[time >= 0.2] += 0.05 / TORQUE
    found = angle(values, time, duty, initial_angle=0.8)
    strained = DRY / 20.0  # as closing left it; it relaxes by moving the shaft until the bristle carries nothing
    assert found[150] == pytest.approx(0.8 + strained, rel=0.02)
    assert found[499] - found[150] == pytest.approx(0.05 / (20.0 + STIFFNESS), rel=0.35)


def test_closing_is_harder_by_the_directional_terms():
    time = times(1.0)
    values = {
        "direction_dependent_friction.viscous_difference": 0.05,
        "direction_dependent_friction.coulomb_difference": 0.03,
    }
    found = angle(values, time, np.zeros(time.size), initial_angle=1.5)
    rest = (DRY + 0.03 - PRELOAD) / STIFFNESS
    expected = rest + (1.5 - rest) * np.exp(-STIFFNESS * time / (BRAKING + 0.05))
    assert np.abs(found - np.maximum(expected, 0.0)).max() < HALF_MILLIVOLT
    opening = np.full(time.size, 0.22)
    assert np.array_equal(angle(values, time, opening), angle({}, time, opening))


def test_load_dependent_friction_takes_a_share_of_the_motor_torque():
    time = times(8.0)
    found = angle({"load_dependent_friction.coefficient": 0.1}, time, np.full(time.size, 0.24))
    assert found[-1] == pytest.approx((0.9 * TORQUE * 0.24 - PRELOAD - DRY) / STIFFNESS, abs=1e-3)


def test_a_hump_of_friction_stops_the_shaft_on_its_flank():
    time = times(10.0)
    values = {
        "position_dependent_friction.amplitude": 0.2,
        "position_dependent_friction.center": 0.8,
        "position_dependent_friction.width": 0.1,
    }
    duty = 0.24
    end = angle(values, time, np.full(time.size, duty))[-1]
    hump = 0.2 * exp(-(((end - 0.8) / 0.1) ** 2))
    assert TORQUE * duty - PRELOAD - STIFFNESS * end == pytest.approx(DRY + hump, abs=1e-3)
    assert end < 0.8


def test_backlash_delays_leaving_the_stop_by_the_gap_at_free_speed():
    gap, share = 0.1, 0.3
    time = times(1.0, 10000.0)
    duty = np.where(time < 0.3, -0.2, 0.25)
    values = {"backlash.gap": gap, "backlash.motor_friction_share": share}
    leaves, without = (time[np.argmax(angle(v, time, duty) > 1e-4)] for v in (values, {}))
    free_speed = (TORQUE * 0.25 - share * DRY) / BRAKING
    assert leaves - without == pytest.approx(gap / free_speed, abs=2e-4)


def test_a_compliant_gear_winds_up_before_the_shaft_moves():
    stiffness = 10.0
    time = times(3.0)
    values = {"gear_compliance.stiffness": stiffness, "gear_compliance.damping": 0.01}
    duty = np.where(time < 1.0, (PRELOAD + 0.9 * DRY) / TORQUE, 0.3)
    soft, stiff = (angle(v, time, duty) for v in (values, {}))
    assert soft[999] == 0.0
    wind = 0.1 * DRY / stiffness  # what is left to wind from 0.9 of the friction to all of it
    speed = (TORQUE * 0.3 - PRELOAD - 0.95 * DRY) / BRAKING
    lag = time[np.argmax(soft > 0.05)] - time[np.argmax(stiff > 0.05)]
    assert lag == pytest.approx(wind / speed, abs=2.5e-3)


def test_cogging_holds_the_shaft_where_the_torques_balance():
    time = times(4.0)
    values = {
        "cogging_torque.amplitude": 0.03,
        "cogging_torque.periods_per_motor_revolution": 2.0,
        "cogging_torque.phase": 0.5,
    }
    end = angle(values, time, np.full(time.size, 0.23))[-1]
    ripple = 0.03 * sin(2.0 * 37.3 * end + 0.5)
    assert TORQUE * 0.23 - PRELOAD - STIFFNESS * end - ripple == pytest.approx(DRY, abs=2e-3)


@pytest.mark.parametrize(
    ("values", "extra"),
    [
        ({"nonlinear_spring.cubic_stiffness": 0.05}, lambda x: 0.05 * x**3),
        (
            {"nonlinear_spring.knee_stiffness": 0.1, "nonlinear_spring.knee_angle": 0.3},
            lambda x: 0.1 * max(x - 0.3, 0.0),
        ),
    ],
)
def test_a_stiffer_spring_settles_where_the_torques_balance(values, extra):
    time = times(12.0)
    end = angle(values, time, np.full(time.size, 0.24))[-1]
    assert TORQUE * 0.24 - PRELOAD - STIFFNESS * end - extra(end) == pytest.approx(DRY, abs=1e-4)


def test_a_compliant_stop_gives_by_load_over_stiffness():
    time = times(2.0)
    values = {"stop_compliance.stiffness": 15.0, "stop_compliance.damping": 0.03, "coulomb_friction": 0.0}
    found = angle(values, time, np.full(time.size, -0.1))
    assert found[-1] == pytest.approx(-(PRELOAD + 0.1 * TORQUE) / (15.0 + STIFFNESS), rel=1e-3)


def test_an_outside_load_acts_only_in_its_window():
    time = times(3.0)
    duty = np.full(time.size, (PRELOAD + STIFFNESS * 0.8) / TORQUE)
    values = {"external_load.torque": 0.25, "external_load.start": 1.0, "external_load.end": 2.0}
    found = angle(values, time, duty, initial_angle=0.8)
    assert np.ptp(found[:1001]) == 0.0
    assert found[2000] < 0.7
    assert np.ptp(found[2001:]) < 1e-4


def test_a_pulsating_load_moves_a_frictionless_shaft_as_a_first_order_lag():
    time = times(10.0)
    duty = np.full(time.size, (PRELOAD + STIFFNESS * 0.8) / TORQUE)
    load = {"external_load.amplitude": 0.05, "external_load.frequency": 1.5, "external_load.phase": 0.7}
    found = angle({**load, "coulomb_friction": 0.0}, time, duty, initial_angle=0.8)
    pulse = 0.05 / (STIFFNESS + 2j * pi * 1.5 * BRAKING) * np.exp(1j * (2 * pi * 1.5 * time + 0.7))
    start = np.imag(pulse[0]) * np.exp(-STIFFNESS * time / BRAKING)
    assert np.abs(found - (0.8 - np.imag(pulse) + start)).max() < HALF_MILLIVOLT


def test_a_stalled_winding_settles_at_its_thermal_balance():
    """Stalled on the open stop, rise = Rth U^2 / R(rise): a quadratic, seen as the duty that lets go."""
    resistance, capacity = 10.0, 0.05
    values = {
        "thermal_resistance.thermal_resistance": resistance,
        "thermal_resistance.heat_capacity": capacity,
    }
    cold, volts = NOMINAL["armature_resistance"], 0.5 * NOMINAL["supply_voltage"]
    heating = 4 * 0.0039 * resistance * volts**2 / cold
    rise = (np.sqrt(1 + heating) - 1) / (2 * 0.0039)
    time = times(12.0, 500.0)
    holding = (PRELOAD + STIFFNESS * pi / 2 - DRY) * cold * (1 + 0.0039 * rise) / (CONSTANT * 13.5)
    for duty_then, leaves in ((1.02 * holding, False), (0.98 * holding, True)):
        found = angle(values, time, np.where(time < 11.99, 0.5, duty_then))
        assert (found[-1] < pi / 2 - 1e-6) == leaves


def test_a_weak_supply_is_a_resistance_that_grows_with_duty():
    time = times(2.0)
    duty = np.full(time.size, 0.4)
    sagging = angle({"supply_sag.source_resistance": 2.0}, time, duty)
    stiffer = angle({"armature_resistance": NOMINAL["armature_resistance"] + 2.0 * 0.4**2}, time, duty)
    assert np.abs(sagging - stiffer).max() < 1e-12


def test_a_dead_band_takes_its_width_off_the_duty():
    time = times(2.0)
    duty = np.where(time < 1.0, 0.25, -0.02)
    narrowed = np.where(time < 1.0, 0.22, 0.0)
    assert np.allclose(angle({"pwm_deadband.width": 0.03}, time, duty), angle({}, time, narrowed), atol=1e-12)


def test_inductance_delays_a_slow_motion_by_its_time_constant():
    """Leaving a stop, the current needs -L/R log(1 - holding/driving) to reach what the load takes."""
    inductance = 0.02
    time = times(0.2, 10000.0)
    duty = np.full(time.size, 0.3)
    leaves = time[np.argmax(angle({"armature_inductance.inductance": inductance}, time, duty) > 2e-5)]
    share = (PRELOAD + DRY) / (TORQUE * 0.3)
    expected = -inductance / NOMINAL["armature_resistance"] * np.log(1.0 - share)
    assert leaves == pytest.approx(expected, abs=4e-4)


def test_a_delay_shifts_the_answer_exactly():
    time = times(2.0)
    duty = np.where(time < 0.5, 0.0, np.where(time < 1.2, 0.25, 0.02))
    late, prompt = (angle({"input_delay.delay": d}, time, duty) for d in (0.02, 0.0))
    assert np.abs(late[20:] - prompt[:-20]).max() < 1e-9


def test_a_sensor_lag_trails_a_ramp_by_speed_times_time_constant():
    time = times(0.2)
    values = {"sensor_lag.time_constant": 0.01}
    duty = np.full(time.size, 0.4)
    lagging, prompt = (angle(v, time, duty) for v in (values, {}))
    speed = np.gradient(prompt, time)
    assert np.abs(prompt - lagging - 0.01 * speed)[80:150].max() < 0.02 * 0.01 * speed.max()


def test_sensor_curvature_is_the_stated_sine():
    time = times(1.0)
    duty = np.full(time.size, 0.24)
    curved = simulate_textbook(
        {"sensor_nonlinearity.amplitude": 0.03, "sensor_nonlinearity.half_waves": 2.0}, time, duty
    )
    x = (simulate_textbook({}, time, duty) - 0.42) / 4.1
    assert np.abs(curved - (0.42 + 4.1 * (x + 0.03 * np.sin(2 * pi * x)))).max() < 1e-12


def test_magnet_play_trails_by_half_its_width_either_way():
    time = times(4.0)
    duty = np.where(time < 2.0, 0.26, 0.0)
    played, true = (angle(v, time, duty) for v in ({"sensor_hysteresis.width": 0.02}, {}))
    assert true[1999] - played[1999] == pytest.approx(0.01, abs=1e-12)
    assert played[-1] - true[-1] == pytest.approx(0.01, abs=1e-12)


def test_the_converter_rounds_to_its_steps():
    time = times(1.0)
    voltage = simulate_textbook({"sensor_quantization.step": 0.02}, time, np.full(time.size, 0.24))
    assert np.abs(voltage / 0.02 - np.round(voltage / 0.02)).max() < 1e-9
    assert np.abs(voltage - simulate_textbook({}, time, np.full(time.size, 0.24))).max() <= 0.01 + 1e-12


def test_relaxation_ends_on_the_plain_spring():
    time = times(15.0, 500.0)
    values = {"relaxation.stiffness": 0.1, "relaxation.time_constant": 0.3, "coulomb_friction": 0.0}
    found = angle(values, time, np.full(time.size, 0.15))
    plain = angle({"coulomb_friction": 0.0}, time, np.full(time.size, 0.15))
    assert found[150] < plain[150] - 0.01
    assert found[-1] == pytest.approx(plain[-1], abs=0.002)


def test_a_square_drag_slows_a_free_fall_as_its_solution_says():
    """Without spring force, friction and motor, constant push: J w' = T - c w^2, soon w = sqrt(T / c)."""
    time = times(0.4)
    values = {"drag.quadratic": 0.02, "coulomb_friction": 0.0, "spring_stiffness": 1e-9}
    found = angle(values, time, np.zeros(time.size), initial_angle=1.5, enabled=np.zeros(time.size))
    speed = np.sqrt(PRELOAD / 0.02)
    settling = NOMINAL["total_inertia"] * asinh(1.0) / (0.02 * speed)
    assert found[100] == pytest.approx(1.5 - speed * (0.1 - settling), abs=0.002)
