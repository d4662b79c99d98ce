"""A diagnosis knows no units: of the same recording in others it says the same.

Factors that are powers of two only change the exponents of floating-point numbers, so that every number of a search has
to be the same: any number with a unit that is left in it shows.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.effects import EFFECT
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.gauge import Gauge
from pierburg_ros.recording import Channel, Recording, read_recording

HALL = read_actuator("pierburg")
POSITION = replace(HALL, quantity="position")
PRACTICE = Path(__file__).parents[3] / "shared/practice"
AS_IT_IS = Gauge()


def recorded(actuator: Actuator, effect: str | None, duration: float) -> Recording:
    """Random steps of duty through an actuator, with an effect as one meets it."""
    random = np.random.default_rng(0)
    time = np.arange(0.0, duration, 0.002)
    duty = random.uniform(-0.05, 0.36, int(duration / 0.6) + 1)[(time / 0.6).astype(int)]
    duty[time < 0.3] = 0.0
    model = Model.nominal(actuator)
    if effect is not None:
        model = model.with_values(EFFECT[effect].typical_values(model.values, model.scales))
    signal = simulate(model, Inputs(time, duty), time)
    noise = 0.00073 * model.scales.reading * random.standard_normal(time.size)
    return Recording("made", actuator.quantity, time, signal + noise, Channel(time, duty))


def diagnosed(recording: Recording, actuator: Actuator, gauge: Gauge) -> Diagnosis:
    """What is said of a recording in the units of `gauge`."""
    return diagnose([gauge.recording(recording)], Model.nominal(gauge.actuator(actuator)), jobs=2).diagnosis


def said(found: Diagnosis, gauge: Gauge) -> dict[str, Any]:
    """Everything that is said but for sentences with numbers, brought back from the units of `gauge`."""
    measured = gauge.measured(found.quantity)
    by = gauge.factor
    return {
        "verdict": found.verdict,
        "effects": {
            (effect.id, name): [
                number and number / by(f"{effect.id}.{name}", p.unit) for number in (p.value, *(p.ci95 or ()))
            ]
            for effect in found.effects
            for name, p in effect.parameters.items()
        },
        "parameters": {
            name: (
                p.drifted,
                p.identifiable,
                *(number / by(name, p.unit) for number in (p.value or 0.0, *(p.ci95 or ()))),
            )
            for name, p in found.parameters.items()
        },
        "changes": [
            (c.parameter, *(when / gauge.time for when in (c.time, *(c.time_ci95 or ())))) for c in found.changes
        ],
        "windows": [(w.start / gauge.time, w.end / gauge.time, w.share, w.regime) for w in found.locations],
        "regimes": [(r.variable, r.chance, r.share_of_residual, r.share_of_time) for r in found.regimes],
        "errors": [
            error and error / measured
            for part in (found.fit.training, found.fit.validation)
            for error in (part.nominal_rmse, part.recalibrated_rmse, part.final_rmse)
        ],
        "candidates": [(c.id, c.evidence, c.status) for c in found.candidates],
        "not_testable": [(each.id, each.why) for each in found.not_testable],
        "limits": len(found.data_quality.limits),
        "advice": found.advice,
    }


@pytest.mark.parametrize(
    ("actuator", "effect", "gauge"),
    [
        pytest.param(HALL, "viscous_friction", Gauge(torque=2.0**7, time=2.0**-4), id="viscous-friction"),
        pytest.param(POSITION, None, Gauge(torque=2.0**-7, time=2.0**3, angle=2.0**5), id="nothing"),
    ],
)
def test_the_same_is_said_to_the_last_digit(actuator: Actuator, effect: str | None, gauge: Gauge) -> None:
    recording = recorded(actuator, effect, 10.0)
    one, other = (said(diagnosed(recording, actuator, each), each) for each in (AS_IT_IS, gauge))
    assert one == other


@pytest.mark.search
@pytest.mark.skipif(not PRACTICE.exists(), reason="the practice recordings are not beside this checkout")
@pytest.mark.parametrize(
    ("practice", "gauge"),
    [("practice-03", Gauge(torque=100.0, time=10.0)), ("practice-11", Gauge(torque=0.01, time=0.1))],
)
def test_the_same_is_said_of_a_practice_recording(practice: str, gauge: Gauge) -> None:
    """Decimal factors round: values agree to far less than their intervals, windows to a thousandth of a minute."""
    recording = read_recording(PRACTICE / practice / "train.mcap")
    one, other = (said(diagnosed(recording, HALL, each), each) for each in (AS_IT_IS, gauge))
    for same in ("verdict", "limits"):
        assert one[same] == other[same]
    assert one["effects"].keys() == other["effects"].keys()
    for name, numbers in one["effects"].items():
        assert other["effects"][name] == pytest.approx(numbers, rel=1e-3)
    drifted = [[name for name, p in each["parameters"].items() if p[0]] for each in (one, other)]
    assert drifted[0] == drifted[1]
    windows = [sorted(window[:2] for window in each["windows"]) for each in (one, other)]
    assert np.shape(windows[0]) == np.shape(windows[1])
    assert np.allclose(*windows, rtol=0.0, atol=0.06)
