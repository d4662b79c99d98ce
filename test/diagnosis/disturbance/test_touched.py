"""A pendulum that is pushed: the push is left out, what acts everywhere is not."""

from __future__ import annotations

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.disturbance.touched import TOUCHED, untouched
from pierburg_ros.estimation.data import data_of, in_parts
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

PENDULUM = Model.nominal(read_actuator("ak80"))
TIME = np.arange(0.0, 16.0, 0.004)
PUSH = {"external_load.torque": 4.0, "external_load.start": 7.0, "external_load.end": 7.3}


def swinging(model: Model) -> Recording:
    """A pendulum under a torque that wanders, an encoder's noise on its angle."""
    random = np.random.default_rng(1)
    torque = 2.0 * np.interp(TIME, np.linspace(0.0, TIME[-1], 30), random.standard_normal(30))
    angle = simulate(model, Inputs(TIME, torque), TIME) + 1e-3 * random.standard_normal(TIME.size)
    return Recording("swing", "position", TIME, angle, Channel(TIME, torque), input="torque")


def test_a_push_is_left_out_with_its_reason() -> None:
    recording = swinging(PENDULUM.with_values({**PUSH, "torque_scale": 0.85}))
    data = in_parts(data_of([recording], PENDULUM))
    rest = untouched(data, PENDULUM, [recording])
    assert rest is not None and all(omission.why == TOUCHED for omission in rest.left_out)
    left_out = sum(end - start for start, end in (omission.span for omission in rest.left_out))
    inside = any(start <= 7.3 and end >= 7.0 for start, end in (omission.span for omission in rest.left_out))
    assert inside and left_out < 2.0
    assert "swing: from" in rest.remarks[0]


@pytest.mark.parametrize("changes", [{}, {"torque_scale": 0.8}, {"viscous_friction.coefficient": 0.2}])
def test_what_acts_everywhere_is_no_push(changes: dict[str, float]) -> None:
    recording = swinging(PENDULUM.with_values(changes))
    assert untouched(in_parts(data_of([recording], PENDULUM)), PENDULUM, [recording]) is None
