"""On the real bench: a model with the effect misses the changed recording by as much as it missed the recording."""

from pathlib import Path

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.comparison.compare import compare
from pierburg_ros.plant import Model
from pierburg_ros.proof.real.channels import with_effect
from pierburg_ros.proof.real.strengths import possible, strength, values_at
from pierburg_ros.recording import read_recording

RECORDING = Path(__file__).parents[4] / "shared/data/xl330/kp400_sin_time_square.mcap"
SERVO = Model.nominal(read_actuator("xl330"))
FITTED = SERVO.with_values(
    {
        "armature_resistance": 1.15,
        "torque_constant": 0.249,
        "coulomb_friction": 0.0131,
        "total_inertia": 0.00687,
        "viscous_friction.coefficient": 0.017,
        "load_dependent_friction.coefficient": 0.58,
    }
)
"""About what the other runs of the bench are diagnosed to."""
INPUT = {"input_delay", "pwm_deadband"}


@pytest.mark.skipif(not RECORDING.exists(), reason="the XL330 recordings (../shared/data) are not here")
@pytest.mark.parametrize("effect", possible(SERVO.actuator))
def test_the_effect_in_both_changes_nothing(effect):
    recording = read_recording(RECORDING)
    values = values_at(effect, strength(effect, "plain", SERVO, []), SERVO)
    changed = with_effect(recording, effect, values, SERVO)
    model = FITTED.with_values({f"{effect}.{name}": value for name, value in values.items()})
    before, after, alone = (compare(*pair).rmse for pair in ((FITTED, recording), (model, changed), (FITTED, changed)))
    # an effect of the sensor smooths or shifts what the model misses too
    assert after == pytest.approx(before, rel=1e-4 if effect in INPUT else 0.1)
    assert effect not in {*INPUT, "sensor_lag"} or alone > 1.2 * before
