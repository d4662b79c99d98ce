"""The monitor on simulated loops: what has changed is named, and nothing where nothing has."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop.service import Service, wandering_supply
from pierburg_ros.control import Settings
from pierburg_ros.monitoring.evidence import decoded, evidence, watched
from pierburg_ros.monitoring.monitor import Monitor
from pierburg_ros.monitoring.movements import Blocks, Movement, Movements, Samples
from pierburg_ros.plant import Inputs, Model, simulate

MODEL = Model.nominal(read_actuator("pierburg"))
RATE = 500.0
ANGLES = np.radians([35.0, 45.0, 55.0, 65.0, 55.0, 45.0, 35.0, 25.0])


def loop(changes, moves=30, hold=1.5, logged=False, seed=1):
    """Samples of a closed loop that makes a move of ten degrees every `hold` [s], on a supply that wanders."""
    setpoint = np.repeat(np.resize(ANGLES, moves), round(hold * RATE))
    volts = wandering_supply(round(moves * hold) + 2, 12.0, 14.5, 600.0, np.random.default_rng(seed))
    supply = np.interp(np.arange(setpoint.size) / RATE, np.arange(volts.size), volts)
    stretch = Service(MODEL.with_values(changes), Settings(), RATE, 0.003, seed).run(setpoint, supply)
    angle = decoded(MODEL.actuator, stretch.hall_voltage)
    measured = supply if logged else np.full(angle.size, np.nan)
    return Samples(stretch.time, angle, stretch.duty, measured, np.ones(angle.size, dtype=bool))


def found(samples):
    """Findings that begin."""
    return [change.finding for change in Monitor(MODEL).take(samples) if change.begins]


def test_a_valve_as_described_gets_no_finding_on_a_supply_that_wanders():
    for seed in (1, 2, 3):
        assert not found(loop({}, seed=seed))


@pytest.mark.parametrize(
    "name, factor",
    [("armature_resistance", 1.17), ("coulomb_friction", 1.4), ("spring_preload", 0.85), ("torque_constant", 0.9)],
)
def test_a_drifted_parameter_is_named_with_its_value(name, factor):
    first = found(loop({name: MODEL.values[name] * factor}))[0]
    assert first.kind == "drift"
    assert name in first.names
    value = float(first.text.split(f"{name} x ")[1].split(" ")[0])
    assert value == pytest.approx(factor, abs=0.03)


def test_without_a_measured_supply_resistance_and_torque_constant_are_tied():
    change = {"armature_resistance": 4.139 * 1.17}
    unlogged, logged = found(loop(change))[0], found(loop(change, logged=True))[0]
    assert {"armature_resistance", "torque_constant"} <= set(unlogged.names)
    assert "together with supply_voltage" in unlogged.text
    assert logged.names == ("armature_resistance",)


def test_a_measured_supply_that_reads_wrong_is_a_drift_of_the_supply():
    samples = loop({}, logged=True)
    wrong = Samples(samples.time, samples.angle, samples.duty, samples.supply_voltage * 1.15, samples.whole)
    assert "supply_voltage" in found(wrong)[0].names


def test_motion_that_no_parameter_explains_is_physics():
    said = found(loop({"sensor_lag.time_constant": 0.004}, moves=40))
    assert [each.kind for each in said] == ["physics"]
    assert "pierburg diagnose" in said[0].text


def test_the_result_does_not_depend_on_how_the_stream_is_cut():
    samples = loop({"coulomb_friction": 0.2007 * 1.4}, moves=12)
    monitor, said = Monitor(MODEL), []
    for first in range(0, samples.time.size, 137):
        said += [change.finding for change in monitor.take(samples.cut(first, first + 137))]
    assert [each.text for each in said] == [each.text for each in found(samples)]


def test_a_window_begins_at_rest_and_holds_the_movement():
    samples = loop({}, moves=10)
    movements, windows = Movements(), []
    for block in Blocks().take(samples):
        windows += [w for w in [movements.take(block)] if w is not None]
    assert len(windows) in (8, 9)  # the first move begins before the noise is known
    for window in windows[1:]:
        assert np.ptp(window.samples.angle) > np.radians(9.0)
        assert np.std(window.samples.angle[:15]) < 2.0 * window.noise
        assert np.ptp(window.aftermath.angle) < np.radians(2.0)
    assert movements.noise == pytest.approx(0.003 / 4.1 * np.pi / 2, rel=0.03)


def test_evidence_finds_the_change_that_made_the_movement():
    """Open loop, by the simulator itself: the sums give back the logarithm of the parameter that was changed."""
    time = np.arange(500) / RATE
    duty = np.where(time < 0.1, 0.1, 0.35)
    names = watched(MODEL)
    for index, name in enumerate(names):
        changed = MODEL.with_values({name: MODEL.values[name] * 1.02})
        angle = decoded(MODEL.actuator, simulate(changed, Inputs(time, duty), time, 0.5))
        samples = Samples(time, angle, duty, np.full(500, np.nan), np.ones(500, dtype=bool))
        piece = evidence(MODEL, Movement(samples, samples.cut(0, 0), 0.001), names, np.zeros(len(names)))
        assert piece.gain[index] / piece.information[index, index] == pytest.approx(np.log(1.02), rel=0.15)
