"""An effect is needed where the recordings are less likely without it, though something may remain then."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
import pytest
from support.fits import made_up
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search import found, together
from pierburg_ros.diagnosis.search.attempts import Attempts
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.needed import needed
from pierburg_ros.diagnosis.search.together import drift_together
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.inference.explanation import Explanation, Variant

LAG = Variant("sensor_lag", ("time_constant",))
LOAD = Variant("external_load", ("torque", "start", "end"))
BENT = {"external_load.torque": -0.002, "external_load.start": 0.3, "external_load.end": 8.0}
STRONG = {"external_load.torque": 0.05, "external_load.start": 0.3, "external_load.end": 8.0}


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


def test_what_all_drifts_with_effects_account_for_is_forgotten_unless_the_effects_are_needed(
    pool: Executor, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a remainder could replace must not keep the search from going on."""
    deep = Explanation(("spring_preload", "coulomb_friction", "armature_resistance"), (LOAD,))
    for creep, kept in ((True, False), (False, True)):
        true = {"spring_preload": 0.28, "coulomb_friction": 0.15}
        data = creeping(true) if creep else data_on(recording({**true, **STRONG}, duration=20.0))
        attempts = attempts_on(data, pool)
        attempts.add(Explanation())
        monkeypatch.setattr(together, "recalibrated", lambda *_, a=attempts: a.whole.fit(Explanation(deep.drifted)))
        begin = {**true, **(BENT if creep else STRONG)}
        monkeypatch.setattr(
            together, "_with_an_effect", lambda seed, a, begin=begin: [a.add(deep, {**seed.values, **begin})]
        )
        assert drift_together(attempts) == kept
        assert any(explanation.variants for explanation in attempts.fits) == kept


@pytest.mark.parametrize("is_needed", [True, False])
def test_what_could_replace_an_effect_is_asked_only_if_a_remainder_could_not(
    monkeypatch: pytest.MonkeyPatch, is_needed: bool
) -> None:
    data, asked = data_on(recording({}, duration=5.0)), list[Explanation]()
    best = made_up(Explanation((), (LAG,)), 1.0, NOMINAL)
    nominal = made_up(Explanation(), 9.0, NOMINAL)
    monkeypatch.setattr(found.Search, "run", lambda search: (search.keep(nominal), search.keep(best))[1])
    monkeypatch.setattr(found.Search, "preferred", lambda _: best)
    monkeypatch.setattr(found, "needed", lambda fit, *_: fit if is_needed else nominal)
    monkeypatch.setattr(found, "fit_rivals", lambda _, fit: asked.append(fit.explanation))
    monkeypatch.setattr(found, "pruned", lambda _: best)
    found.search(data, NOMINAL)
    assert asked == ([best.explanation] if is_needed else [])
