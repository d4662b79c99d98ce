"""An effect is needed where the recordings are less likely without it, though something may remain then."""

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.attempts import Attempts
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.needed import needed
from pierburg_ros.diagnosis.search.selection import adequate
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.explanation import Explanation, Variant

LAG = Variant("sensor_lag", ("time_constant",))
LOAD = Variant("external_load", ("torque", "start", "end"))
BENT = {"external_load.torque": -0.002, "external_load.start": 0.3, "external_load.end": 8.0}


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with ThreadPoolExecutor(2) as threads:
        yield threads


def attempts_on(data: Data, pool: Executor) -> Attempts:
    return Attempts(data, NOMINAL, pool, lambda _: None, Beam())


def creeping(true: dict[str, float]) -> Data:
    """A recording whose sensor reads too much at the beginning, ever less: no effect of the catalogue."""
    plain = recording(true, duration=20.0)
    slow = 0.002 * np.exp(-np.arange(plain.measured.size) / 2500.0)
    return data_on(replace(plain, measured=plain.measured + slow))


def fitted(explanation: Explanation, attempts: Attempts, values: dict[str, float]) -> Fit:
    attempts.add(Explanation())
    return attempts.add(explanation, values)


def test_an_effect_that_is_there_is_needed(pool: Executor) -> None:
    true = {"sensor_lag.time_constant": 0.012}
    attempts = attempts_on(data_on(recording(true, duration=20.0)), pool)
    best = fitted(Explanation((), (LAG,)), attempts, true)
    assert needed(best, attempts, pool) is best


def test_an_effect_that_bends_to_what_no_effect_describes_is_not(pool: Executor) -> None:
    attempts = attempts_on(creeping({}), pool)
    best = fitted(Explanation((), (LOAD,)), attempts, BENT)
    assert adequate(best) and not adequate(attempts.fits[Explanation()])
    assert needed(best, attempts, pool).explanation == Explanation()


def test_drifts_alone_are_left_as_they_are(pool: Executor) -> None:
    attempts = attempts_on(data_on(recording({"spring_preload": 0.32}, duration=20.0)), pool)
    best = fitted(Explanation(("spring_preload",)), attempts, {})
    assert needed(best, attempts, pool) is best
