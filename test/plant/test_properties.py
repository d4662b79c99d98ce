"""What holds for any valve and any duty: no energy from nothing, no way past a stop, no creep while stuck."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state

NOMINAL = Model.nominal(read_actuator("pierburg"))
OPEN_STOP = math.pi / 2


@st.composite
def valves(draw: st.DrawFn, most_effects: int = 3) -> Model:
    """A valve with base parameters around nominal and up to `most_effects` effects of plausible strength."""
    values = {
        name: NOMINAL.values[name] * draw(st.floats(0.7, 1.4))
        for name in ("armature_resistance", "torque_constant", "spring_stiffness", "spring_preload", "coulomb_friction")
    }
    chosen = draw(st.lists(st.sampled_from(EFFECTS), max_size=most_effects, unique_by=lambda effect: effect.id))
    for effect in chosen:
        for p in effect.parameters:
            drawn = draw(st.sampled_from(p.choices) if p.choices else st.floats(*p.expected(NOMINAL.scales)))
            values[f"{effect.id}.{p.name}"] = drawn
    breakaway = "static_friction.breakaway_torque"
    if breakaway in values:
        values[breakaway] = max(values[breakaway], values["coulomb_friction"])
    source = "supply_sag.source_resistance"
    if source in values:
        values[source] = min(values[source], 0.9 * values["armature_resistance"])
    return NOMINAL.with_values(values)


duties = st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=12)


@given(valves(), duties)
def test_finite_and_between_the_stops(model: Model, levels: list[float]) -> None:
    time = np.arange(len(levels)) * 0.15
    record = model.record()
    state = new_state(record)
    elastic = model.values["stop_compliance.stiffness"] > 0.0
    give = 1.0 if elastic else 0.0
    for level in levels:
        for _ in range(15):
            advance(record[0], state[0], level, np.nan, True, 0.01)
            assert -give <= state["angle"][0] <= OPEN_STOP + give
            assert math.isfinite(state["velocity"][0])
    assert np.isfinite(simulate(model, Inputs(time, np.array(levels)), np.linspace(0.0, time[-1], 50))).all()


@given(st.floats(0.0, OPEN_STOP), st.floats(-12.0, 12.0), st.floats(0.0, 0.05), st.booleans(), st.floats(0.0, 0.1))
def test_energy_never_appears_from_nothing(
    angle: float, velocity: float, viscous: float, closed_bridge: bool, cubic: float
) -> None:
    """No supply: the sum of kinetic and spring energy only falls."""
    values = {"viscous_friction.coefficient": viscous, "nonlinear_spring.cubic_stiffness": cubic}
    record = NOMINAL.with_values(values).record()
    state = new_state(record, angle, velocity)

    def energy() -> float:
        at = float(state["angle"][0])
        return float(0.5 * 2.4602e-6 * state["velocity"][0] ** 2 + 0.29 * at + 0.07095 * at**2 + 0.25 * cubic * at**4)

    before = energy()
    for _ in range(60):
        advance(record[0], state[0], 0.0, np.nan, closed_bridge, 0.0007)
        assert energy() <= before + 1e-9
        before = energy()


@given(st.floats(0.05, 1.5), st.floats(-0.98, 0.98), st.floats(0.0, 1.0))
def test_stuck_shaft_stays_bit_for_bit(angle: float, share: float, jitter: float) -> None:
    """A push within the friction, however it varies, moves nothing."""
    holding = (0.29 + 0.1419 * angle) * 4.139 / (37.3 * 0.022 * 13.5)
    play = 0.2007 * 4.139 / (37.3 * 0.022 * 13.5)
    record = NOMINAL.record()
    state = new_state(record, angle)
    for k in range(200):
        duty = holding + share * play * (1.0 - jitter * (k % 2))
        advance(record[0], state[0], duty, np.nan, True, 0.002)
    assert state["angle"][0] == angle
    assert state["velocity"][0] == 0.0


@settings(max_examples=30)
@given(valves(most_effects=2), st.floats(-0.2, 0.4))
def test_constant_duty_comes_to_rest(model: Model, duty: float) -> None:
    """Every valve is passive: with nothing pulsating it stands still in the end."""
    model = model.with_values({"external_load.amplitude": 0.0})
    time = np.linspace(0.0, 40.0, 4001)
    voltage = simulate(model, Inputs(time[:1], np.array([duty])), time)
    assert np.ptp(voltage[-100:]) < 2e-3 + model.values["sensor_quantization.step"]
