"""What a search amounts to: its verdict, and how far each effect is believed."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.fits import found_among, made_up, of_chi2
from support.recordings import NOMINAL, data_on, recording, recording_under

from pierburg_ros.diagnosis.remainder.left_out import LeftOut
from pierburg_ros.diagnosis.remainder.remainder import Remainder
from pierburg_ros.diagnosis.remainder.shape import Shape
from pierburg_ros.diagnosis.search.found import Found, search
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion, conclude, verdict_on
from pierburg_ros.estimation.data import Data, data_of
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.explanation import WHEN, Explanation, Variant
from pierburg_ros.recording import Channel, Recording

pytestmark = pytest.mark.search

DEAD = {"pwm_deadband.width": 0.02}
LAG = Variant("sensor_lag", ("time_constant",))
VISCOUS = Variant("viscous_friction", ("coefficient",))
DELAY = Variant("input_delay", ("delay",))


@pytest.fixture(scope="module")
def data() -> Data:
    return data_on(recording({}, duration=5.0))


@pytest.mark.parametrize(
    ("explanation", "ratio", "verdict"),
    [
        (Explanation(), 1.02, "consistent"),
        (Explanation(("spring_preload",)), 1.02, "parameter_drift"),
        (Explanation(changed="spring_preload"), 1.02, "parameter_drift"),
        (Explanation((), (LAG,)), 1.02, "missing_physics"),
        (Explanation(("spring_preload",), (LAG,)), 1.02, "missing_physics"),
        (Explanation(), 1.2, "unexplained"),
        (Explanation(("spring_preload",), (LAG,)), 1.2, "unexplained"),
    ],
)
def test_the_verdict_is_what_was_changed_unless_a_tenth_of_the_noise_is_left(
    explanation: Explanation, ratio: float, verdict: str
) -> None:
    assert verdict_on(made_up(explanation, ratio, NOMINAL)) == verdict


@pytest.mark.parametrize(
    ("drifting", "verdict"), [(0.0, "missing_physics"), (0.2, "missing_physics"), (0.35, "unexplained")]
)
def test_little_may_be_left_and_up_to_a_tenth_of_the_noise_if_it_is_white(drifting: float, verdict: str) -> None:
    """Noise that is 6 % above its estimate is noise; what drifts slowly beneath it is physics that nothing names."""
    white = made_up(Explanation((), (LAG,)), 1.0, NOMINAL)
    slow = drifting * np.sqrt(2.0) * np.sin(np.linspace(0.0, 20.0, white.solution.residual.size))
    residual = white.solution.residual + slow if drifting else 1.06 * white.solution.residual
    fit = replace(white, solution=replace(white.solution, residual=residual))
    assert fit.ratio == pytest.approx(np.sqrt(1.0 + drifting**2) if drifting else 1.06, rel=0.02)
    assert verdict_on(fit) == verdict


def supported(found: Found, effect: str) -> tuple[float, float | None]:
    support = conclude(found).supports[effect]
    return support.confidence, support.gain


def test_an_effect_weighs_as_the_explanations_with_it_do(data: Data) -> None:
    """exp(-chi2 / 2) of each: 1 for the chosen one, exp(-2) for a rival 4 above; samples are independent."""
    chosen, rival = of_chi2(Explanation((), (LAG,)), 0.0, NOMINAL), of_chi2(Explanation((), (DELAY,)), 4.0, NOMINAL)
    repetition = chosen.repetition
    confidence, gain = supported(found_among(data, chosen, rival), "sensor_lag")
    assert confidence == pytest.approx(1.0 / (1.0 + math.exp(-2.0 / repetition)))
    assert gain == pytest.approx(4.0 / repetition)


def test_beside_a_drift_that_may_be_alone_the_gain_is_over_the_smaller_one(data: Data) -> None:
    chosen = of_chi2(Explanation(("spring_preload",), (LAG,)), 0.0, NOMINAL)
    drift = of_chi2(Explanation(("spring_preload",)), 300.0, NOMINAL)
    other = of_chi2(Explanation(("coulomb_friction", "spring_preload")), 250.0, NOMINAL)
    larger = of_chi2(Explanation(("coulomb_friction", "spring_preload"), (DELAY,)), 1.0, NOMINAL)
    confidence, gain = supported(found_among(data, chosen, drift, other, larger), "sensor_lag")
    assert gain == pytest.approx(250.0 / chosen.repetition, rel=1e-6)
    assert confidence == pytest.approx(1.0)


def test_steps_of_the_converter_are_seen_and_not_believed() -> None:
    """Steps of 20 mV beside 2 mV of noise: the model gives values on the grid, and nothing else is needed."""
    plain = recording({}, duration=6.0)
    clean = data_of([plain], NOMINAL).runs[0].simulated(NOMINAL)
    noisy = clean + 0.002 * np.random.default_rng(1).standard_normal(clean.size)
    rounded = Recording("steps.mcap", "hall_voltage", plain.time, np.round(noisy / 0.02) * 0.02, plain.command)
    stepped = data_on(rounded)
    found = conclude(found_among(stepped, made_up(Explanation(), 1.0, NOMINAL)))
    assert found.verdict == "missing_physics"
    assert found.chosen.explanation.effects == ("sensor_quantization",)
    assert (found.supports["sensor_quantization"].confidence, found.supports["sensor_quantization"].gain) == (1.0, None)
    simulated = stepped.runs[0].simulated(found.model)
    np.testing.assert_allclose(simulated / 0.02, np.round(simulated / 0.02), atol=1e-9)


@pytest.mark.parametrize(("step", "known", "named"), [(0.02, 0.0, True), (0.002, 0.0, False), (0.02, 0.02, False)])
def test_beside_what_remains_coarse_steps_are_named_that_the_model_lacks(
    data: Data, step: float, known: float, named: bool
) -> None:
    nominal = NOMINAL.with_values({"sensor_quantization.step": known})
    base = made_up(Explanation(), 2.0, nominal)
    stepped = replace(found_among(replace(data, step=step), base), nominal=nominal)
    found = conclude(stepped, Remainder(base, {}, {}, {}, None))
    assert found.verdict == "unexplained"
    assert found.final.explanation.effects == (("sensor_quantization",) if named else ())
    assert found.model.values["sensor_quantization.step"] == (step if named else known)


@pytest.mark.parametrize(("helped", "parts", "confidence"), [(3, 3, 0.8), (2, 4, 0.5), (0, 2, 0.25)])
def test_few_recordings_leave_doubt(data: Data, helped: int, parts: int, confidence: float) -> None:
    """Laplace's rule of succession: helping in 3 of 3 parts is believed by (3 + 1) / (3 + 2)."""
    base = made_up(Explanation((), (LAG,)), 1.6, NOMINAL)
    left_out = {"sensor_lag": LeftOut(0.02, 0.01, helped, parts)}
    found = conclude(found_among(data, made_up(Explanation(), 2.0, NOMINAL)), Remainder(base, {}, left_out, {}, None))
    assert found.verdict == "unexplained"
    assert found.chosen is base
    assert found.supports["sensor_lag"].confidence == pytest.approx(confidence)
    assert found.supports["sensor_lag"].left_out == left_out["sensor_lag"]


def test_a_confirmed_shape_is_part_of_the_model(data: Data) -> None:
    grid = {"angle": np.array([0.0, 1.0]), "velocity": np.array([-1.0, 1.0]), "torque": np.full((2, 2), 0.02)}
    over_time = (np.zeros(0), np.zeros(0))
    shape = Shape(NOMINAL.with_residual(grid), NOMINAL, 0.02, 0.01, "in words", over_time)
    base = made_up(Explanation(), 2.0, NOMINAL)
    for known, model in ((shape, shape.model), (None, NOMINAL)):
        found = conclude(found_among(data, base), Remainder(base, {}, {}, {}, known))
        assert found.model is model
        assert found.shape is known


def conclusion_on(changes: dict[str, float], seed: int = 0) -> Conclusion:
    return conclude(search(data_on(recording(changes, seed=seed)), NOMINAL))


@pytest.mark.search
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_nominal_valve_is_consistent(seed: int) -> None:
    found = conclusion_on({}, seed=seed)
    assert found.verdict == "consistent"
    assert found.chosen.explanation.size == 0


@pytest.mark.search
def test_a_drifted_resistance_is_a_drift_and_no_effect() -> None:
    found = conclusion_on({"armature_resistance": 4.9})
    assert found.verdict == "parameter_drift"
    assert found.chosen.explanation.drifted == ("armature_resistance",)
    assert found.chosen.values["armature_resistance"] == pytest.approx(4.9, rel=0.01)


@pytest.mark.search
def test_stiction_is_named_with_its_values() -> None:
    found = conclusion_on({"static_friction.breakaway_torque": 0.26, "static_friction.stribeck_velocity": 0.1})
    assert found.verdict == "missing_physics"
    assert found.chosen.explanation.effects == ("static_friction",)
    assert found.chosen.values["static_friction.breakaway_torque"] == pytest.approx(0.26, rel=0.03)


@pytest.mark.search
def test_an_effect_behind_a_drift_is_named() -> None:
    found = conclusion_on({"sensor_lag.time_constant": 0.012, "spring_preload": 0.32})
    assert found.verdict == "missing_physics"
    assert found.chosen.explanation.effects == ("sensor_lag",)
    assert found.chosen.explanation.drifted == ("spring_preload",)
    estimate = found.estimates["sensor_lag.time_constant"]
    assert estimate.low < 0.012 < estimate.high


@pytest.mark.search
def test_viscous_friction_comes_with_its_exact_tie() -> None:
    found = conclusion_on({"viscous_friction.coefficient": 0.03})
    assert found.chosen.explanation.effects == ("viscous_friction",)
    ties = {alternative.instead for alternative in found.alternatives}
    assert ("armature_resistance", "torque_constant") in ties
    assert ("armature_resistance", "supply_voltage") in ties


@pytest.mark.search
def test_an_effect_that_only_what_validates_shows_is_named() -> None:
    load = {"external_load.torque": 0.06, "external_load.start": 3.2, "external_load.end": 3.7}
    data = data_on(recording(load))
    (run,) = data.runs
    during = (run.time > 3.0) & (run.time < 9.0)
    hidden = replace(data, runs=(replace(run, train=run.train & ~during, validation=during),))
    assert search(hidden, NOMINAL).chosen.explanation.effects == ("external_load",)


@pytest.mark.search
def test_a_change_in_the_middle_is_dated() -> None:
    plain = recording({})
    after = NOMINAL.with_values({"armature_resistance": 4.9})
    hall = data_of([plain], NOMINAL).runs[0].simulated(NOMINAL, Switch(after, 13.4))
    noise = 0.003 * np.random.default_rng(7).standard_normal(hall.size)
    duty = Channel(plain.time, plain.command.values)
    changed = Recording("changed.mcap", "hall_voltage", plain.time, hall + noise, duty)
    found = conclude(search(data_on(changed), NOMINAL))
    assert found.verdict == "parameter_drift"
    assert found.chosen.explanation.changed == "armature_resistance"
    assert found.chosen.values["armature_resistance" + WHEN] == pytest.approx(13.4, abs=0.3)


@pytest.mark.search
def test_of_explanations_that_fit_alike_one_that_fails_on_the_validation_samples_is_out() -> None:
    """A dead band is a larger preload while the duty stays above it: only a return at no duty tells them apart."""
    random = np.random.default_rng(3)
    time = np.arange(0.0, 24.0, 0.002)
    duty = random.uniform(0.1, 0.36, 41)[(time / 0.6).astype(int)]
    validation = data_on(recording({})).validation
    duty[validation & (time % 1.5 > 0.5)] = 0.0
    duty[np.roll(validation, round(1.5 / 0.002))] = 0.36  # to the open stop, where the valve forgets where it came from
    found = conclude(search(data_on(recording_under(duty, time, DEAD, random)), NOMINAL))
    assert found.chosen.explanation.effects == ("pwm_deadband",)
    assert found.chosen.explanation.drifted == ()
    assert ("spring_preload",) not in {alternative.instead for alternative in found.alternatives}
