"""Why an effect is believed, and what to record next, in words with their numbers."""

import math

import pytest
from support.fits import made_up
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.evidence.quality import Limit
from pierburg_ros.diagnosis.remainder.left_out import LeftOut
from pierburg_ros.diagnosis.report.words import advice, cautioned, needless, reason, summary, unsure
from pierburg_ros.diagnosis.schema import BaseParameter, Change, Effect, Errors, FitQuality, NotTestable
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.diagnosis.verdict.conclusion import Support
from pierburg_ros.inference.explanation import Explanation, Variant

RIVAL = made_up(Explanation(("coulomb_friction",), (Variant("backlash", ("gap",)),)), 1.2, NOMINAL)
TIED = Effect(
    id="viscous_friction",
    confidence=0.99,
    parameters={},
    indistinguishable_from=[["armature_resistance", "torque_constant"]],
    explanation="",
)


@pytest.mark.parametrize(
    ("support", "words"),
    [
        (
            Support(0.99, gain=812.34, without=RIVAL),
            "quantities is coulomb friction + backlash: it fits worse by 812 in",
        ),
        (
            Support(0.5, gain=-6.9, without=RIVAL),
            "quantities is coulomb friction + backlash: it fits better by 7 in",
        ),
        (Support(1.0), "All samples lie on this grid"),
        (Support(0.8, left_out=LeftOut(0.02, 0.0104, 1, 2, ("a",))), "helps in 1 of 2 parts, on a. "),
        (Support(0.8, left_out=LeftOut(0.02, 0.0104, 2, 2, ("a", "b"))), "0.0104 V with it; all recordings share it. "),
        (Support(0.8, weight=Weight(800.0, 200.0)), "explains 80 % of the evidence against the model without it"),
        (
            Support(0.8, weight=Weight(800.0, 200.0, 90.0, 0.65, apart=0.25)),
            "gains 90. It moves the signal by 1.4 times the remaining error. The best replacement gains 75 % as much.",
        ),
    ],
    ids=[
        "evidence",
        "a better fit with more numbers",
        "grid",
        "some recordings",
        "all recordings",
        "beside what remains",
        "of the error",
    ],
)
def test_an_effect_is_believed_for_a_reason_with_its_numbers(support: Support, words: str) -> None:
    assert words in reason(support, "V")


def test_what_is_not_sure_enough_is_told_with_its_probability() -> None:
    told = unsure({"backlash": 0.43, "sensor_lag": 0.081}, "An error remains.")
    assert told == "An error remains. Not sure enough to be named: backlash (43 %), sensor lag (8.1 %)."
    assert unsure({}, "An error remains.") == "An error remains."


def test_the_headline_says_what_cannot_be_told_apart_and_not_the_first_of_it() -> None:
    errors = Errors(nominal_rmse=0.1, recalibrated_rmse=0.01, final_rmse=0.004)
    fit = FitQuality(noise_floor=0.004, training=errors, validation=errors)
    said = summary("missing_physics", [TIED], {}, [], fit, "V")
    assert said.startswith(
        "The model lacks viscous friction, or armature resistance and torque constant together, which fit alike. "
    )
    spring = BaseParameter(
        nominal=0.1, value=0.2, unit="N.m", ci95=None, identifiable=True, drifted=True,
        indistinguishable_from=[["coulomb_friction"]],
    )  # fmt: skip
    said = summary("parameter_drift", [], {"spring_preload": spring}, [], fit, "V")
    assert "instead of 0.1, or coulomb friction, which fit alike. " in said


@pytest.mark.parametrize(("after", "warned"), [(0.05, False), (0.105, False), (0.15, True)])
def test_a_corrected_model_that_predicts_worse_is_not_recommended(after: float, warned: bool) -> None:
    """On unseen data the model as described is off by 0.1."""
    errors = Errors(nominal_rmse=0.1, recalibrated_rmse=0.09, final_rmse=after)
    fit = FitQuality(noise_floor=0.004, training=errors, validation=errors)
    assert ("use the model as described" in summary("unexplained", [TIED], {}, [], fit, "V")) == warned


def test_an_error_that_is_not_finite_is_not_known() -> None:
    errors = Errors(nominal_rmse=0.1, recalibrated_rmse=0.09, final_rmse=math.inf)
    fit = FitQuality(noise_floor=0.004, training=errors, validation=errors)
    assert "is not known; the noise is 0.004 V." in summary("unexplained", [], {}, [], fit, "V")


@pytest.mark.parametrize(
    ("ends", "when"),
    [((29.35, 34.07), "between 29.4 and 34.1 s"), ((31.71, 31.74), "at 31.7 s"), (None, "at 31.7 s")],
    ids=["at rest", "moving", "no interval"],
)
def test_a_change_is_told_with_the_moments_between_which_it_lies(ends, when) -> None:
    errors = Errors(nominal_rmse=0.1, recalibrated_rmse=0.01, final_rmse=0.004)
    fit = FitQuality(noise_floor=0.004, training=errors, validation=errors)
    preload = BaseParameter(
        nominal=0.29, value=0.29, unit="N.m", ci95=None, identifiable=True, drifted=True,
        indistinguishable_from=[["external_load"]],
    )  # fmt: skip
    change = Change(parameter="spring_preload", time=31.71, time_ci95=ends, before=0.29, after=0.322)
    said = summary("parameter_drift", [], {"spring_preload": preload}, [change], fit, "V")
    assert f"spring preload changes {when} from 0.29 to 0.322, or external load, which fit alike. " in said


def test_advice_tells_ties_apart_and_shows_what_is_hidden_each_once() -> None:
    hidden = [NotTestable(id="backlash", why="", record="duty below 0")]
    limit = Limit("slow_sampling", "sampled at 60 Hz")
    steps = advice("missing_physics", [TIED, TIED], {}, hidden, [limit, limit])
    assert steps[0] == limit.record
    assert steps[1].startswith("To tell viscous friction from armature resistance and torque constant: ")
    assert "measure the motor's resistance at standstill" in steps[1] and "`free: false`" in steps[1]
    assert steps[2] == "To see backlash, record: duty below 0."
    assert len(steps) == 3


def test_advice_sends_nobody_to_stops_that_are_not_there() -> None:
    spring = BaseParameter(
        nominal=0.1, value=0.2, unit="N.m", ci95=None, identifiable=True, drifted=True,
        indistinguishable_from=[["gravity_torque"]],
    )  # fmt: skip
    said = [advice("parameter_drift", [], {"spring_preload": spring}, [], [], stops)[0] for stops in (True, False)]
    assert "stops" in said[0] and "stops" not in said[1] and "by other means" in said[1]


def test_what_decides_nothing_is_said_before_anything_else() -> None:
    still = Limit("no_movement", "The shaft never moves.", decisive=True)
    assert cautioned([still], "All is well.") == "Nothing can be concluded: The shaft never moves. All is well."
    assert cautioned([Limit("short", "5 s only.")], "All is well.") == "All is well."


def test_what_would_fit_and_is_not_needed_is_said_and_not_named() -> None:
    assert needless((), "Something is left.") == "Something is left."
    one, two = (needless(effects, "Something is left.") for effects in (("external_load",), ("backlash", "sensor_lag")))
    assert one.startswith("Something is left. External load would explain the remaining error, but so would")
    assert one.endswith("it is not named.")
    assert "Backlash, and sensor lag would explain" in two and two.endswith("they are not named.")
