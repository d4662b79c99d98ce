"""The audit of recordings: what they are like, and what is refused or left open because of it."""

from dataclasses import replace

import numpy as np
import pytest
from support.motions import CORNERS, NOISE, run_along
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.quality import data_quality, limits_of
from pierburg_ros.errors import InputError
from pierburg_ros.inference.data import refuse_unusable

STANDING = ((0.0, 0.5), (12.0, 0.5))


def kinds(run, actuator=PIERBURG) -> set[str]:
    return {limit.kind for limit in limits_of([run], actuator, NOISE)}


def swinging(time):
    return 0.2 * np.sin(time)


def test_describes_sampling_and_excitation():
    quality = data_quality([run_along(duty=swinging)], PIERBURG, NOISE)
    assert quality.rate == 500.0 and quality.jitter == 0.0 and quality.gaps == 0
    assert quality.stops_touched == ["closed"] and quality.saturated_share == 0.0
    assert quality.excited.startswith("angle 0 to 57 degrees, both directions, 1 reversal, 3 starts from standstill")
    assert quality.excited.endswith("duty -0.20 to 0.20, negative duty at the closed stop: yes")


def test_counts_gaps_and_jitter():
    run = run_along(duty=swinging)
    kept = (run.time < 4.0) | (run.time > 4.5)
    random = np.random.default_rng(0)
    time = np.sort(run.time + random.uniform(0.0, 0.001, run.time.size))
    gappy = replace(run, time=time[kept], measured=run.measured[kept], block=run.block[kept], counts=run.counts[kept])
    quality = data_quality([gappy], PIERBURG, NOISE)
    assert quality.gaps == 1 and "gaps" in kinds(gappy)
    assert quality.jitter == pytest.approx(0.001 / np.sqrt(6.0), rel=0.1)


def test_a_shaft_that_never_moves_decides_nothing():
    limits = limits_of([run_along(STANDING, swinging)], PIERBURG, NOISE)
    assert limits[0].kind == "no_movement" and limits[0].decisive
    assert "friction" in limits[0].finding and "move the shaft" in limits[0].record


def test_full_duty_throughout_decides_nothing():
    run = run_along(CORNERS, lambda time: np.where(time < 9.8, 1.0, -1.0))
    saturated = [limit for limit in limits_of([run], PIERBURG, NOISE) if limit.kind == "saturated"]
    assert saturated and saturated[0].decisive
    assert data_quality([run], PIERBURG, NOISE).saturated_share == 1.0


def test_says_what_short_slow_and_narrow_recordings_leave_open():
    narrow = ((0.0, 0.5), (1.0, 0.5), (2.0, 0.7), (4.0, 0.7))
    assert kinds(run_along(narrow, swinging, rate=60.0)) == {
        "short", "slow_sampling", "one_direction", "little_travel", "closed_stop", "open_stop",
    }  # fmt: skip
    assert "constant_duty" in kinds(run_along())


def test_a_rate_has_no_exponent():
    slow = next(each for each in limits_of([run_along(rate=60.0)], PIERBURG, NOISE) if each.kind == "slow_sampling")
    assert "sampled at 60 Hz" in slow.finding and "(they could at 500 Hz)" in slow.finding


def test_an_actuator_without_stops_lacks_none():
    bench = read_actuator("xl330")
    run = run_along(duty=swinging)
    position = replace(run, quantity="position", measured=(run.measured - 0.42) / 4.1 * np.pi / 2)
    assert not kinds(position, bench) & {"closed_stop", "open_stop"}
    assert "closed stop" not in data_quality([position], bench, 0.001).excited


def test_refuses_what_is_too_short_to_judge():
    refuse_unusable([recording({}, duration=3.0)], NOMINAL.actuator)
    with pytest.raises(InputError, match=r"too short \(600 samples over 1.20 s\); expected at least 200 samples"):
        refuse_unusable([recording({}, duration=1.2)], NOMINAL.actuator)
