"""Steps of the converter are seen where they are coarse beside the noise, and only there."""

from dataclasses import replace

import numpy as np
import pytest
from recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.evidence_data import evidence_of
from pierburg_ros.diagnosis.explanation import Explanation
from pierburg_ros.diagnosis.resolution import coarse_step, rounded
from pierburg_ros.diagnosis.search import Search


def stepped(step: float, noise: float):
    """A nominal recording with noise, rounded to multiples of `step`."""
    given = recording({}, duration=20.0)
    clean = evidence_of([given], PIERBURG).runs[0].simulated(NOMINAL)
    values = clean + noise * np.random.default_rng(1).standard_normal(clean.size)
    return evidence_of([replace(given, measured=np.round(values / step) * step)], PIERBURG)


@pytest.mark.parametrize(("step", "noise"), [(0.015, 0.004), (0.02, 0.002), (0.05, 0.001)])
def test_coarse_steps_are_seen(step: float, noise: float) -> None:
    assert coarse_step(stepped(step, noise)) == pytest.approx(step, rel=1e-6)


@pytest.mark.parametrize(("step", "noise"), [(0.00122, 0.001), (0.00122, 0.004), (0.005, 0.004), (1e-6, 0.002)])
def test_steps_that_noise_hides_are_not(step: float, noise: float) -> None:
    assert coarse_step(stepped(step, noise)) == 0.0


def test_the_rounded_model_gives_values_on_the_grid() -> None:
    data = stepped(0.02, 0.002)
    fit = rounded(Search(data, NOMINAL).fit(Explanation()), 0.02)
    simulated = data.runs[0].simulated(fit.model)
    np.testing.assert_allclose(simulated / 0.02, np.round(simulated / 0.02), atol=1e-9)
    assert fit.explanation.effects == ("sensor_quantization",)
