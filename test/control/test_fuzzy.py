"""The fuzzy stage against Table II, against scikit-fuzzy, and in what a control law may rely on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.control import Settings
from pierburg_ros.control.fuzzy import duty_of, pi_output_for

SETTINGS = Settings(pi_output_support=0.3, derivative_support=200.0, negative=-0.9, positive=0.8)
TABLE_II = {
    ("N", "N"): "negative_big",
    ("N", "Z"): "negative",
    ("N", "P"): "zero",
    ("Z", "N"): "negative",
    ("Z", "Z"): "zero",
    ("Z", "P"): "positive",
    ("P", "N"): "zero",
    ("P", "Z"): "positive",
    ("P", "P"): "positive_big",
}
PEAK = {"N": -1.0, "Z": 0.0, "P": 1.0}
ratio = st.floats(-1.5, 1.5)


def duty(settings, pi_ratio, derivative_ratio):
    """Duty at inputs given as shares of their supports."""
    return duty_of(
        settings.record(),
        pi_ratio * settings.pi_output_support,
        derivative_ratio * settings.derivative_support,
    )


def even_sets():
    return SETTINGS.with_values({"negative": -0.5, "positive": 0.5})


@pytest.mark.parametrize(("derivative", "pi_output"), TABLE_II)
def test_each_rule_alone_gives_the_centre_of_its_output_set(derivative, pi_output):
    expected = getattr(SETTINGS, TABLE_II[derivative, pi_output])
    assert duty(SETTINGS, PEAK[pi_output], PEAK[derivative]) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_by_default_both_inputs_at_their_ends_ask_for_all_the_duty_there_is(direction):
    assert duty(Settings(), direction, direction) == direction


def test_inputs_beyond_the_support_count_as_its_end():
    assert duty(SETTINGS, 40.0, 0.0) == duty(SETTINGS, 1.0, 0.0)
    assert duty(SETTINGS, 0.3, -9.0) == duty(SETTINGS, 0.3, -1.0)


def scikit_fuzzy_stage(settings):
    """The same stage built from scikit-fuzzy's own control system."""
    control = pytest.importorskip("skfuzzy.control")
    from skfuzzy import trimf

    inputs = np.linspace(-1.0, 1.0, 3)
    pi_output, derivative = (control.Antecedent(inputs, name) for name in ("pi_output", "derivative"))
    for antecedent in (pi_output, derivative):
        for name, peak in PEAK.items():
            antecedent[name] = trimf(inputs, [peak - 1.0, peak, peak + 1.0])
    base = 0.01
    centres = {name: getattr(settings, name) for name in set(TABLE_II.values())}
    universe = np.unique(np.concatenate([np.linspace(c - base, c + base, 401) for c in centres.values()]))
    conclusion = control.Consequent(universe, "duty", defuzzify_method="centroid")
    for name, centre in centres.items():
        conclusion[name] = trimf(universe, [centre - base, centre, centre + base])
    rules = [
        control.Rule(derivative[row] & pi_output[column], conclusion[name]) for (row, column), name in TABLE_II.items()
    ]
    return control.ControlSystemSimulation(control.ControlSystem(rules))


def test_agrees_with_scikit_fuzzy():
    peer = scikit_fuzzy_stage(SETTINGS)
    generator = np.random.default_rng(7)
    for pi_ratio, derivative_ratio in generator.uniform(-1.0, 1.0, (60, 2)):
        peer.input["pi_output"] = pi_ratio
        peer.input["derivative"] = derivative_ratio
        peer.compute()
        # scikit-fuzzy integrates over 400 pieces a set: its own error is below 1e-4
        assert duty(SETTINGS, pi_ratio, derivative_ratio) == pytest.approx(peer.output["duty"], abs=1e-4)


@given(ratio, ratio)
def test_stays_between_the_outer_centres(pi_ratio, derivative_ratio):
    assert SETTINGS.negative_big <= duty(SETTINGS, pi_ratio, derivative_ratio) <= SETTINGS.positive_big


@given(ratio, ratio)
def test_is_odd_where_the_output_sets_are(pi_ratio, derivative_ratio):
    settings = even_sets()
    mirrored = -duty(settings, -pi_ratio, -derivative_ratio)
    assert duty(settings, pi_ratio, derivative_ratio) == pytest.approx(mirrored, abs=1e-12)


@given(ratio, ratio, ratio)
def test_evenly_spaced_sets_never_give_less_for_more(one, other, third):
    settings = even_sets()
    low, high = sorted((one, other))
    assert duty(settings, low, third) <= duty(settings, high, third) + 1e-12
    assert duty(settings, third, low) <= duty(settings, third, high) + 1e-12


@given(ratio, ratio, st.floats(-0.3, 0.3), st.floats(0.5, 0.99))
def test_uneven_sets_rise_with_the_pi_output_at_moderate_derivatives(one, other, derivative_ratio, centre):
    settings = SETTINGS.with_values({"negative": -centre, "positive": centre})
    low, high = sorted((one, other))
    assert duty(settings, low, derivative_ratio) <= duty(settings, high, derivative_ratio) + 1e-12


@given(st.floats(-0.75, 0.75), st.floats(-0.1, 0.1))
def test_the_inverse_gives_the_pi_output_of_a_duty(wanted, derivative_ratio):
    record = SETTINGS.record()
    derivative = derivative_ratio * SETTINGS.derivative_support
    reachable = np.clip(wanted, duty(SETTINGS, -1.0, derivative_ratio), duty(SETTINGS, 1.0, derivative_ratio))
    pi_output = pi_output_for(record, reachable, derivative)
    assert duty_of(record, pi_output, derivative) == pytest.approx(reachable, abs=1e-9)
