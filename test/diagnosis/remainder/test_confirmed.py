"""A residual torque stands where unseen data confirm it: of several recordings, those left out."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.remainder.confirmed import confirmed
from pierburg_ros.diagnosis.remainder.shape import Shape
from pierburg_ros.estimation.data import Data

NOTHING = Shape(NOMINAL, NOMINAL, 1.0, 1.0, "", (np.empty(0), np.empty(0)))


def stands(shape: Shape, data: Data) -> bool:
    with ThreadPoolExecutor(2) as pool:
        return confirmed(shape, data, pool)


def test_of_one_recording_the_samples_that_validate_confirm_it() -> None:
    data = data_on(recording({}, duration=2.0))
    assert stands(replace(NOTHING, after=0.89), data)
    assert not stands(replace(NOTHING, after=0.92), data)


@pytest.mark.search
def test_a_torque_that_all_recordings_lack_is_confirmed() -> None:
    stiffer = {"nonlinear_spring.cubic_stiffness": 0.04}
    data = data_on(*(recording(stiffer, duration=8.0, seed=seed) for seed in range(2)))
    assert stands(NOTHING, data)


@pytest.mark.search
def test_a_torque_of_one_recording_alone_is_not_whatever_its_own_blocks_say() -> None:
    loads = (0.03, -0.03)
    data = data_on(*(recording({"external_load.torque": load}, duration=8.0, seed=3) for load in loads))
    assert not stands(replace(NOTHING, after=0.5), data)
