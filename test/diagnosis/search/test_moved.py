"""What a quantity moves beside what remains: nothing that a drifting parameter can do instead."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.moved import moved
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant

DELAY, LOAD = Variant("input_delay", ("delay",)), Variant("external_load", ("torque", "start", "end"))
LATE = {"input_delay.delay": 0.02}


def moved_by(variant: Variant, values: dict[str, float], data: Data, *drifted: str) -> float:
    fit = Estimator(data, NOMINAL).at(Explanation(drifted, (variant,)), values)
    return moved(data, NOMINAL, fit)[variant]


def test_it_is_the_share_of_what_goes_of_what_goes_and_what_remains():
    clean = recording(LATE, duration=8.0)
    wave = 30.0 * NOISE * np.sin(40.0 * clean.time)
    for remains in (np.zeros_like(wave), wave):
        data = data_on(replace(clean, measured=clean.measured + remains))
        with_it, without = (data.residual(NOMINAL.with_values(each)) for each in (LATE, {}))
        parts = [
            float(
                np.mean((without - with_it)[seen] ** 2)
                / np.mean(np.square([without - with_it, with_it])[:, seen])
                / 2.0
            )
            for seen in (data.train, data.validation)
        ]
        assert moved_by(DELAY, LATE, data) == pytest.approx(min(parts), abs=0.1)


def test_what_remains_on_unseen_samples_counts_as_well():
    clean = recording(LATE, duration=8.0)
    data = data_on(clean)
    assert moved_by(DELAY, LATE, data) > 0.9
    elsewhere = replace(clean, measured=clean.measured + 1000.0 * NOISE * data.validation)
    assert moved_by(DELAY, LATE, data_on(elsewhere)) < 0.5


def test_a_load_that_never_ends_does_nothing_that_a_preload_could_not():
    clean = recording({"spring_preload": 0.3}, duration=8.0)
    data = data_on(replace(clean, measured=clean.measured + 10.0 * NOISE * np.sin(40.0 * clean.time)))
    values = {"external_load.torque": 0.01, "external_load.start": 0.0, "external_load.end": 1e9}
    with_it, without = (data.residual(NOMINAL.with_values(each)) for each in (values, {}))
    assert np.mean((without - with_it) ** 2) > 2.0 * np.mean(with_it**2)
    assert moved_by(LOAD, values, data) < 0.2
    assert moved_by(LOAD, values, data, "spring_preload") < 0.2


def test_a_drift_counts_beside_the_others_that_drift_and_not_beside_all():
    data = data_on(recording({"armature_resistance": 5.0}, duration=8.0))
    fit = Estimator(data, NOMINAL).at(Explanation(("armature_resistance",)), {"armature_resistance": 5.0})
    assert moved(data, NOMINAL, fit)["armature_resistance"] > 0.9
