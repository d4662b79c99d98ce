"""Ranges in which an error gathers: found where it was put, silent where it was not."""

import numpy as np
import pytest
from support.motions import NOISE, run_along
from support.recordings import PIERBURG

from pierburg_ros.diagnosis.location.regimes import regimes
from pierburg_ros.diagnosis.motion import motion_of


def wandering(seed: int):
    """A shaft that wanders between random angles for a minute, with rests."""
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.3, 0.8, 110))
    angles = np.repeat(random.uniform(0.1, 1.4, 55), 2)
    return motion_of(run_along(np.column_stack([times - times[0], angles])), PIERBURG, NOISE)


def noise_of(motion, seed: int = 0) -> np.ndarray:
    return 0.01 * np.random.default_rng(seed).standard_normal(motion.time.size)


def test_an_error_in_a_band_of_angle_is_found_there():
    motion = wandering(1)
    band = (motion.angle > 0.6) & (motion.angle < 0.8)
    found = regimes(motion, noise_of(motion) + np.where(band, 0.05, 0.0))
    assert found[0].variable in ("angle", "stop_distance")
    angle = next(regime for regime in found if regime.variable == "angle")
    assert angle.range == pytest.approx((0.6, 0.8), abs=0.08)
    assert angle.share_of_residual > 2.0 * angle.share_of_time
    assert 0.0 < angle.chance <= 0.01 and angle.unit == "rad"


def test_an_error_that_comes_late_is_found_in_time():
    motion = wandering(2)
    late = motion.time > 0.8 * motion.time[-1]
    found = {regime.variable: regime for regime in regimes(motion, noise_of(motion) + np.where(late, 0.05, 0.0))}
    assert found["time_since_start"].range[0] == pytest.approx(0.8 * motion.time[-1], rel=0.06)


@pytest.mark.parametrize("seed", range(4))
def test_noise_gathers_nowhere(seed):
    motion = wandering(seed)
    assert regimes(motion, noise_of(motion, seed)) == []


def test_no_error_no_regime():
    motion = wandering(3)
    assert regimes(motion, np.zeros(motion.time.size)) == []


def test_correlated_errors_without_a_cause_rarely_stand_out():
    """Bursts at random moments: with 7 variables and a chance of 0.01 each, about one in 15 shows any."""
    claimed = 0
    for seed in range(12):
        motion = wandering(seed)
        random = np.random.default_rng(100 + seed)
        moments = random.uniform(0.0, motion.time[-1], 60)
        bursts = sum(np.exp(-(((motion.time - moment) / 0.3) ** 2)) for moment in moments)
        found = regimes(motion, noise_of(motion) + 0.03 * bursts)
        claimed += any(regime.variable != "time_since_start" for regime in found)
    assert claimed <= 3
