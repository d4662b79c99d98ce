"""The torque that a model lacks: seen where and when it was put there."""

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.evidence.missing_torque import MissingTorque, missing_torque, rhythms, spans
from pierburg_ros.estimation.data import data_of, in_parts
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

RANDOM = np.random.default_rng(3)
OWN = NOMINAL.scales
"""What is missing is given in multiples of these."""


def lacking(changes: dict[str, float], duration: float = 24.0) -> MissingTorque:
    """What the nominal model lacks of a valve with `changes`."""
    data = data_on(recording(changes, duration))
    return missing_torque(data, data.runs[0], NOMINAL)


def test_a_load_is_seen_at_its_size_and_with_its_sign() -> None:
    """A larger preload closes the valve: positive, as every load torque."""
    missing = lacking({"spring_preload": 0.32})
    assert OWN.torque * np.median(missing.torque) == pytest.approx(0.03, abs=0.003)
    assert OWN.torque * abs(np.median(lacking({}).torque)) < 0.003


def test_only_what_moves_is_looked_at_and_its_angle_is_that_of_the_shaft() -> None:
    missing = lacking({})
    assert np.min(np.abs(missing.velocity)) * OWN.angle / OWN.time > 0.09
    assert np.min(missing.angle) == pytest.approx(0.0, abs=0.06)
    assert np.max(missing.angle) == pytest.approx(1.0, abs=0.06)


@pytest.mark.parametrize("centre", [0.4, 0.8, 1.2])
def test_a_tight_spot_is_found_at_its_angle(centre: float) -> None:
    """Bins are 0.05 rad wide, and the velocity is taken over 0.04 s: one of the four nearest counts."""
    tight = {
        "position_dependent_friction.amplitude": 0.08,
        "position_dependent_friction.center": centre,
        "position_dependent_friction.width": 0.08,
    }
    assert OWN.angle * lacking(tight).tight_spots(1)[0] == pytest.approx(centre, abs=0.08)


def test_a_load_for_a_while_is_found_in_its_time() -> None:
    load = {"external_load.torque": 0.08, "external_load.start": 9.0, "external_load.end": 14.0}
    start, end, torque = lacking(load).spans(1)[0]
    assert (OWN.time * start, OWN.time * end) == (pytest.approx(9.0, abs=0.6), pytest.approx(14.0, abs=0.6))
    # Torques far from the median are clipped, so that a slip does not pass for a load: its sign is what remains.
    assert torque > 0.0


def test_a_load_on_a_pendulum_under_a_voltage_is_found_in_its_time() -> None:
    """No spring takes an error back there: inertia, gravity and back-EMF are read from the motion."""
    servo = Model.nominal(read_actuator("xl330"))
    time = np.arange(0.0, 24.0, 0.004)
    duty = np.random.default_rng(6).uniform(-0.6, 0.6, 35)[(time / 0.7).astype(int)]
    load = {"external_load.torque": 0.02, "external_load.start": 9.0, "external_load.end": 16.0}
    angle = simulate(servo.with_values(load), Inputs(time, duty), time) + 0.0015 * RANDOM.standard_normal(time.size)
    data = in_parts(data_of([Recording("servo", "position", time, angle, Channel(time, duty))], servo))
    (start, end, torque), own = missing_torque(data, data.runs[0], servo).spans(1)[0], servo.scales
    assert (own.time * start, own.time * end) == (pytest.approx(9.0, abs=0.6), pytest.approx(16.0, abs=0.6))
    assert own.torque * torque == pytest.approx(0.02, rel=0.2)


def test_a_load_that_goes_on_has_no_end() -> None:
    """More after 400 of the actuator's own times, or less before: the one is as likely as the other."""
    time = np.arange(0.0, 600.0, 0.2)
    torque = np.where(time > 400.0, 0.05, 0.0) + 0.01 * RANDOM.standard_normal(time.size)
    before, after = sorted(spans(time, torque, 600.0, 2))
    assert before == (0.0, pytest.approx(400.0, abs=5.0), pytest.approx(-0.05, rel=0.1))
    assert after == (pytest.approx(400.0, abs=5.0), 0.0, pytest.approx(0.05, rel=0.1))


def test_rhythms_are_found_at_uneven_places_strongest_first() -> None:
    place = np.sort(RANDOM.uniform(0.0, 30.0, 1500))
    torque = np.sin(2 * np.pi * 2.3 * place) + 0.5 * np.sin(2 * np.pi * 5.7 * place + 1.0)
    torque += 0.3 * RANDOM.standard_normal(place.size)
    # Frequencies are a quarter of 1 / 30 apart.
    assert rhythms(place, torque, (0.5, 10.0), 2) == [pytest.approx(2.3, abs=0.01), pytest.approx(5.7, abs=0.01)]


def test_what_hardly_moves_has_neither_rhythms_nor_tight_spots() -> None:
    few = MissingTorque(*(np.linspace(0.0, 1.0, 10) for _ in range(4)), gear_ratio=37.3, end=1.0)
    assert few.turns((1.0, 12.0), 3) == few.pulses((0.1, 20.0), 3) == few.tight_spots(2) == []
