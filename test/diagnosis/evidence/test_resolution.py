"""Steps of the converter are seen where they are coarse beside the noise, and only there."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.evidence.data import EvidenceData, evidence_of
from pierburg_ros.diagnosis.evidence.resolution import counted
from pierburg_ros.diagnosis.search.explanation import Explanation
from pierburg_ros.diagnosis.search.fits import Search
from pierburg_ros.diagnosis.search.selection import ADEQUATE, EXPLAINED
from pierburg_ros.diagnosis.verdict.conclusion import rounded


def stepped(step: float, noise: float) -> EvidenceData:
    """A nominal recording with noise, rounded to multiples of `step`."""
    given = recording({}, duration=20.0)
    clean = evidence_of([given], PIERBURG).runs[0].simulated(NOMINAL)
    values = clean + noise * np.random.default_rng(1).standard_normal(clean.size)
    return evidence_of([replace(given, measured=np.round(values / step) * step)], PIERBURG)


@pytest.mark.parametrize(("step", "noise"), [(0.015, 0.004), (0.02, 0.002), (0.05, 0.001)])
def test_coarse_steps_are_seen(step: float, noise: float) -> None:
    assert stepped(step, noise).step == pytest.approx(step, rel=1e-6)


@pytest.mark.parametrize(("step", "noise"), [(0.00122, 0.001), (0.00122, 0.004), (0.005, 0.004), (1e-6, 0.002)])
def test_steps_that_noise_hides_are_not(step: float, noise: float) -> None:
    assert stepped(step, noise).step == 0.0


def test_where_in_a_step_the_shaft_rests_is_no_evidence() -> None:
    everywhere = np.linspace(-0.5, 0.5, 10_001)
    assert counted(everywhere, 0.5) == pytest.approx(everywhere @ everywhere, rel=1e-3)
    for place in (0.0, 0.3, -0.5):
        assert counted(np.full(10_001, place), 0.5) == pytest.approx(counted(everywhere, 0.5))
    assert counted(np.full(12, 0.7), 0.5) == pytest.approx(12 * (0.2**2 + 1 / 12))
    assert counted(everywhere, 0.0) == pytest.approx(everywhere @ everywhere)


def test_a_valve_that_rests_off_the_middle_of_steps_is_still_explained() -> None:
    data = stepped(0.045, 0.001)
    fit = Search(data, NOMINAL).fit(Explanation())
    assert np.sqrt(fit.chi2 / fit.solution.residual.size) > EXPLAINED
    assert fit.ratio < ADEQUATE


def test_the_rounded_model_gives_values_on_the_grid() -> None:
    data = stepped(0.02, 0.002)
    fit = rounded(Search(data, NOMINAL).fit(Explanation()), 0.02)
    simulated = data.runs[0].simulated(fit.model)
    np.testing.assert_allclose(simulated / 0.02, np.round(simulated / 0.02), atol=1e-9)
    assert fit.explanation.effects == ("sensor_quantization",)
