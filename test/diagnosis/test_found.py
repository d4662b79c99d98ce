"""What is told of a choice: shares of the mismatch, and which model is handed out."""

from types import SimpleNamespace

import numpy as np
import pytest
from support.recordings import NOMINAL, disturbed, recording

from pierburg_ros.diagnosis.found import MISMATCH, Share, found, shares
from pierburg_ros.inference.choice import Name
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import adequate, rms_of
from pierburg_ros.inference.infer import infer
from pierburg_ros.workers import workers

LAG, PLAY = Variant("sensor_lag", ("time_constant",)), Variant("backlash", ("gap",))


def left(excess: float, *variants: Variant):
    """A fit that leaves so much above the squared noise."""
    ratio = (1.0 + excess) ** 0.5
    return SimpleNamespace(
        ratio=ratio,
        structure=100.0 if excess > 0.0 else 0.0,
        explanation=Explanation((), variants),
    )


def choice(described: float, estimated: float, handed, fits=(), **rivals: float):
    """A choice whose named effects leave so much at best if they are missing."""
    names = {effect: Name(1.0, handed, left(rival)) for effect, rival in rivals.items()}
    return SimpleNamespace(
        described=left(described), estimated=left(estimated), handed=handed, fits=(handed, *fits), names=names
    )


def whole(parts) -> float:
    return parts.re_estimated + sum(each.beside for each in parts.effects.values()) + parts.remains


def test_one_effect_takes_what_parameters_leave():
    parts = shares(choice(10.0, 8.0, left(0.0, LAG), sensor_lag=8.0))
    assert parts.re_estimated == pytest.approx(0.2) and parts.remains == 0.0
    assert parts.effects == {"sensor_lag": Share(pytest.approx(0.8), pytest.approx(0.8))}


def test_two_effects_share_in_proportion_to_what_is_lost_without_each():
    both = left(1.0, LAG, PLAY)
    parts = shares(choice(10.0, 9.0, both, [left(3.0, LAG)], sensor_lag=7.0, backlash=3.0))
    assert parts.effects["sensor_lag"] == Share(pytest.approx(0.6), pytest.approx(0.6))
    assert parts.effects["backlash"].beside == pytest.approx(0.2)
    assert parts.effects["backlash"].alone == 0.0, "no fit has it alone"
    assert (parts.re_estimated, parts.remains) == (pytest.approx(0.1), pytest.approx(0.1))


@pytest.mark.parametrize(
    ("described", "estimated", "handed", "rivals"),
    [
        (10.0, 8.0, left(2.0, LAG, PLAY), {"sensor_lag": 5.0, "backlash": 4.0}),
        (10.0, 8.0, left(0.0, LAG), {"sensor_lag": 6.0}),
        (10.0, 0.0, left(0.0), {}),
        (10.0, 4.0, left(4.0), {}),
        (10.0, 12.0, left(3.0, LAG), {"sensor_lag": 12.0}),
        (10.0, 12.0, left(11.0, LAG), {"sensor_lag": 12.0}),
        (10.0, 6.0, left(0.0), {}),
        (10.0, 6.0, left(2.0, LAG), {"sensor_lag": 2.0}),
    ],
    ids=[
        "two effects",
        "one effect",
        "a drift",
        "nothing helps",
        "re-estimated ends in a local minimum",
        "all do",
        "a change in mid-recording",
        "an effect that takes nothing",
    ],
)
def test_shares_add_up_to_one(described, estimated, handed, rivals):
    parts = shares(choice(described, estimated, handed, **rivals))
    assert whole(parts) == pytest.approx(1.0)
    assert all(0.0 <= part <= 1.0 for part in (parts.re_estimated, parts.remains))


def test_a_change_in_mid_recording_is_a_share_of_parameters():
    assert shares(choice(10.0, 6.0, left(0.0))).re_estimated == pytest.approx(1.0)


def test_without_a_mismatch_there_is_nothing_to_share():
    parts = shares(choice(0.9 * MISMATCH, 0.0, left(0.0)))
    assert (parts.re_estimated, parts.effects, parts.remains) == (None, {}, None)


@pytest.mark.search
@pytest.mark.parametrize(
    "made",
    [
        pytest.param(lambda: disturbed({"sensor_lag.time_constant": 0.03}, seed=1), id="beside a wave of no effect"),
        pytest.param(lambda: recording({"armature_resistance": 4.6}, 12.0), id="a drift"),
    ],
)
def test_the_model_handed_out_is_never_worse_on_held_out_blocks_than_what_was_fitted(made):
    """Where only noise is left, others may be lower by a share of what noise makes of it."""
    inferred = infer([made()], NOMINAL)
    with workers(None) as pool:
        told = found(inferred, pool)
    choice, held_out = inferred.choice, told.data.validation
    errors = [rms_of(fit, held_out) for fit in (choice.described, choice.estimated, *choice.fits)]
    luck = 1.0 + 3.0 / np.sqrt(np.count_nonzero(held_out)) if adequate(told.written) else 1.0
    assert len(errors) >= 3
    assert rms_of(told.written, held_out) <= luck * min(errors)
    assert whole(told.shares) == pytest.approx(1.0)
