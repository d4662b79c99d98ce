"""The discriminating experiment: exact ties stay ties, and a sequence is found where one exists."""

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.identification.experiment.discriminate import Segment, discriminate, judge, linear_separation
from pierburg_ros.identification.experiment.discriminate_report import words
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.explanations import explanation, refitted_names

TIME = np.arange(5_000) / 500.0


def lag_and_delay(nominal):
    """10 ms each: they differ by the square of that, so that 2 ms would leave a 25th of the difference."""
    return (nominal.with_values({name: 0.01}) for name in ("sensor_lag.time_constant", "input_delay.delay"))


@pytest.fixture(scope="module")
def lag_against_delay(nominal):
    return discriminate(*lag_and_delay(nominal), duration=10.0, rate=200.0)


def test_an_exact_tie_leaves_nothing_whatever_the_sequence(nominal):
    # Viscous friction equals a joint change of armature resistance and torque constant.
    viscous = explanation("viscous_friction", nominal)
    duty = duty_sequence("sharp_steps", nominal, TIME)
    design = judge(viscous, nominal, TIME, duty, (Segment("sharp_steps", 0),) * 4, noise=0.003)
    assert design.separation < 0.1
    assert not design.settles
    assert "look alike" in words(design, ("viscous_friction", "nominal"), "V", 0.003)


def test_lag_and_delay_separate_on_the_sequence_found(lag_against_delay):
    assert lag_against_delay.settles
    assert lag_against_delay.duty.shape == lag_against_delay.time.shape
    assert np.max(np.abs(lag_against_delay.duty)) <= 1.0


def test_the_sequence_found_beats_the_papers_steps(nominal, lag_against_delay):
    first, second = lag_and_delay(nominal)
    time = lag_against_delay.time
    duty = duty_sequence("steps", nominal, time)
    assert lag_against_delay.separation > linear_separation(first, second, time, duty, 0.003)


def test_a_model_is_not_fitted_to_its_special_case(nominal):
    # The nominal valve is backlash of no gap; only the answer with a gap can tell the two apart.
    backlash = explanation("backlash", nominal)
    duty = duty_sequence("negative", nominal, TIME)
    segments = (Segment("negative", 0),) * 4
    there, back = (
        judge(first, second, TIME, duty, segments, noise=0.003).separation
        for first, second in ((backlash, nominal), (nominal, backlash))
    )
    assert there == back > 6.0


def test_the_limit_bounds_the_duty(nominal):
    first, second = (explanation(name, nominal) for name in ("supply_sag", "nominal"))
    design = discriminate(first, second, duration=5.0, rate=100.0, limit=0.25)
    assert np.max(np.abs(design.duty)) <= 0.25


def test_explanations_are_effects_files_or_nominal(nominal, tmp_path):
    assert explanation("nominal", nominal) is nominal
    assert explanation("static_friction", nominal).active_effects == ("static_friction",)
    path = tmp_path / "worn.yaml"
    nominal.with_values({"coulomb_friction": 0.25}).write(path)
    assert explanation(str(path), nominal).values["coulomb_friction"] == 0.25
    with pytest.raises(InputError, match="wear is neither an effect nor a model file"):
        explanation("wear", nominal)


def test_when_a_load_acted_is_not_refitted(nominal):
    loaded = explanation("external_load", nominal)
    assert "external_load.amplitude" in refitted_names(loaded)
    assert "external_load.torque" in refitted_names(loaded)
    assert "external_load.end" not in refitted_names(loaded)
