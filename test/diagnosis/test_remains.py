"""What a missing torque goes with: torques that are made of one thing each, along a motion that is drawn."""

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.remains import SAMPLES_OF_NODE, Lacking, in_words, lacking, shapes, torque_map
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fitter, ladder
from pierburg_ros.inference.motion import motion_of

SAMPLES = 4000
TIME = np.linspace(0.0, 40.0, SAMPLES)
# rates that share no period, so that angle, speed and load tell each other apart
ANGLE = 4.0 * np.sin(0.71 * TIME) + 2.3 * np.sin(1.93 * TIME + 0.4) + 0.9 * np.sin(3.37 * TIME)
VELOCITY = np.gradient(ANGLE, TIME)
ACCELERATION = np.gradient(VELOCITY, TIME)
LOAD = 0.5 * np.sin(ANGLE) + 0.3 * ACCELERATION


def lacked(torque: np.ndarray, parameters: tuple[np.ndarray, ...] = (ACCELERATION,), turns: bool = True) -> Lacking:
    """A missing torque along the motion, beside what `parameters` can make of it."""
    noise = 0.02 * np.std(torque) * np.random.default_rng(3).standard_normal(SAMPLES)
    basis = np.linalg.qr(np.stack(parameters, axis=1))[0]
    return Lacking(torque + noise, torque + noise, ANGLE, VELOCITY, TIME, LOAD, basis, turns)


@pytest.mark.parametrize(
    ("torque", "over", "form"),
    [
        (np.ones(SAMPLES), "constant", "constant"),
        (np.sign(VELOCITY), "velocity", "direction"),
        (VELOCITY, "velocity", "linear"),
        (VELOCITY * np.abs(VELOCITY), "velocity", "square"),
        (VELOCITY**3, "velocity", "cube"),
        (ANGLE, "angle", "linear"),
        (ANGLE**2, "angle", "square"),
        (np.sin(ANGLE + 0.7), "angle", "once_a_turn"),
        (np.cos(2.0 * ANGLE + 0.7), "angle", "twice_a_turn"),
        (np.abs(LOAD) * np.sign(VELOCITY), "load", "linear"),
        (TIME, "time", "linear"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_torque_made_of_one_thing_is_named_as_that_with_nearly_all_of_it(torque, over, form):
    found = shapes(lacked(0.1 * torque))
    assert (found[0].over, found[0].form, found[0].direction) == (over, form, "both")
    assert found[0].share > 0.99
    assert len(found) == 1


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["positive", "negative"])
def test_what_comes_in_one_direction_alone_is_said_so(sign):
    one_way = np.where(sign * VELOCITY > 0.0, VELOCITY * np.abs(VELOCITY), 0.0)
    found = shapes(lacked(0.1 * one_way))
    assert (found[0].over, found[0].form) == ("velocity", "square")
    assert found[0].direction == ("positive" if sign > 0.0 else "negative")
    assert 0.4 < found[0].share < 0.9
    assert ", when the angle grows" in in_words(found[:1], lacked(one_way), "rotary") or sign < 0.0


def test_two_things_have_shares_of_what_each_is():
    """The squares of two torques that have nothing in common add up."""
    speed = VELOCITY * np.abs(VELOCITY) / np.std(VELOCITY * np.abs(VELOCITY))
    turn = np.sin(ANGLE) / np.std(np.sin(ANGLE))
    found = {each.form: each.share for each in shapes(lacked(0.1 * (2.0 * speed + turn)))}
    assert found == pytest.approx({"square": 0.8, "once_a_turn": 0.2}, abs=0.03)


def test_what_parameters_can_make_is_not_missing():
    found = shapes(lacked(0.1 * VELOCITY + 0.05 * np.sin(ANGLE), (ACCELERATION, VELOCITY)))
    assert [each.form for each in found] == ["once_a_turn"]


def test_a_shaft_between_stops_has_no_turns():
    forms = {each.form for each in shapes(lacked(0.1 * np.sin(ANGLE), turns=False))}
    assert not forms & {"once_a_turn", "twice_a_turn"}


def test_noise_goes_with_nothing():
    noise = 0.1 * np.random.default_rng(7).standard_normal(SAMPLES)
    at = lacked(noise)
    assert shapes(at) == []
    assert "goes with neither angle, velocity, load nor time" in in_words([], at, "rotary")


def test_a_shaft_that_hardly_moves_shows_no_torque():
    none = np.empty(0)
    at = Lacking(none, none, none, none, none, none, np.empty((0, 0)), False)
    assert shapes(at) == [] and torque_map(at) is None
    assert "hardly moves" in in_words([], at, "rotary")


def test_the_map_holds_the_torque_that_made_it():
    """Bilinear over angle and velocity, which a map between nodes can hold exactly."""
    truth = 0.03 + 0.02 * ANGLE - 0.01 * VELOCITY
    grid = torque_map(lacked(truth))
    at = 0.03 + 0.02 * grid["angle"][:, np.newaxis] - 0.01 * grid["velocity"][np.newaxis, :]
    # a node in a corner that few samples reach stays near its neighbours
    inside = np.hypot(*np.meshgrid(np.linspace(-1, 1, at.shape[0]), np.linspace(-1, 1, at.shape[1]), indexing="ij")) < 1
    assert grid["torque"][inside] == pytest.approx(at[inside], abs=0.1 * np.std(truth))


def test_there_is_no_map_of_a_few_samples():
    at = lacked(0.1 * VELOCITY)
    few = slice(0, 4 * SAMPLES_OF_NODE)
    short = Lacking(*(each[few] for each in (at.torque, at.own, ANGLE, VELOCITY, TIME, LOAD, at.basis)), True)
    assert torque_map(short) is None


def test_a_friction_that_the_simulator_has_is_missing_along_its_motion():
    """The torque that the description lacks is coefficient w (section 7 of docs/contract.md).

    At steps of the duty the filter of the motion rounds corners, and the noise of the angle is in its derivatives.
    """
    coefficient = 0.03
    data = data_on(recording({"viscous_friction.coefficient": coefficient}))
    fitter = Fitter(data, NOMINAL, ladder(data)[0])
    balance = Balance(data.actuator, tuple(motion_of(run, NOMINAL, fitter.constant) for run in data.runs))
    at = lacking(fitter.fit(Explanation(("spring_preload",)), NOMINAL.values, 0), balance)
    friction = coefficient * at.velocity
    assert np.sqrt(np.mean((at.own - friction) ** 2)) < 0.3 * np.sqrt(np.mean(friction**2))
    (found, *_) = shapes(at)
    assert (found.over, found.form, found.direction) == ("velocity", "linear", "both")
    assert found.share > 0.8


def test_what_is_missing_has_its_word_and_unit():
    at = lacked(0.1 * VELOCITY)
    assert " N.m (root mean square)" in in_words([], at, "rotary") and in_words([], at, "rotary").startswith(
        "a torque of "
    )
    assert " N (root mean square)" in in_words([], at, "linear") and in_words([], at, "linear").startswith(
        "a force of "
    )
