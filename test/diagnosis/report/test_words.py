"""Why an effect is believed, and what to record next, in words with their numbers."""

from types import SimpleNamespace

import pytest
from support.recordings import PIERBURG

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.found import Share, Shares
from pierburg_ros.diagnosis.limits import Limit as Strongest
from pierburg_ros.diagnosis.limits import Seen
from pierburg_ros.diagnosis.quality import Limit
from pierburg_ros.diagnosis.report.findings import converter, ruled_out, short_times_show
from pierburg_ros.diagnosis.report.words import (
    advice,
    divided,
    handed_out,
    held,
    reason,
    stopped,
    summary,
    unseen_error,
)
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Change,
    Doubted,
    Effect,
    Errors,
    FitQuality,
    NotTestable,
    Remaining,
)
from pierburg_ros.inference.choice import Name
from pierburg_ros.inference.explanation import Explanation, Variant

TIED = Effect(
    id="viscous_friction",
    confidence=0.99,
    parameters={},
    indistinguishable_from=[["armature_resistance", "torque_constant"]],
    explanation="",
)
NOTHING_LEFT = Remaining(share=0.0, looks_like="noise")
LEFT = Remaining(share=0.3, looks_like="a torque that grows with the square of the speed")
PLAY = Explanation(("coulomb_friction",), (Variant("backlash", ("gap",)),))
UNDIVIDED = Shares(None, {}, None)


def fit(explanation: Explanation = PLAY, ratio: float = 1.0, shape: object = None) -> SimpleNamespace:
    """What the words read of a fit."""
    values = {"coulomb_friction": 0.25, "backlash.gap": 0.04} if explanation.size else {"coulomb_friction": 0.2}
    nominal = SimpleNamespace(values={"coulomb_friction": 0.2, "backlash.gap": 0.0})
    model = SimpleNamespace(residual_torque=shape, values=values)
    return SimpleNamespace(explanation=explanation, ratio=ratio, model=model, fitter=SimpleNamespace(nominal=nominal))


def found(verdict: str = "unexplained", written=None, shares=UNDIVIDED, stopped_by=None, actuator=PIERBURG):
    """What the words read of a diagnosis: its verdict, the model that is handed out, shares and effort."""
    handed = fit()
    return SimpleNamespace(
        choice=SimpleNamespace(verdict=verdict, handed=handed),
        data=SimpleNamespace(actuator=actuator),
        written=written or handed,
        shares=shares,
        inferred=SimpleNamespace(
            effort=SimpleNamespace(stopped_by=stopped_by),
            drifts=("armature_resistance", "coulomb_friction"),
            free=("armature_resistance", "torque_constant", "coulomb_friction"),
        ),
    )


def quality_of(final: float = 0.004, nominal: float = 0.1) -> FitQuality:
    errors = Errors(nominal_rmse=nominal, recalibrated_rmse=0.01, final_rmse=final)
    return FitQuality(noise_floor=0.004, training=errors, validation=errors)


def said(verdict, effects=(), parameters=None, changes=(), left=NOTHING_LEFT, unsure=(), **of) -> str:
    """The summary."""
    return summary(found(verdict, **of), effects, parameters or {}, changes, quality_of(), left, unsure)


def spring(**changes) -> BaseParameter:
    fields = {"nominal": 0.1, "value": 0.2, "unit": "N.m", "ci95": None, "identifiable": True, "drifted": True}
    return BaseParameter(**{**fields, **changes})


@pytest.mark.parametrize(
    ("rival", "other"),
    [(PLAY, "coulomb friction + backlash"), (Explanation(), "the model as described")],
    ids=["another", "nominal"],
)
def test_an_effect_is_believed_for_a_reason_with_its_numbers(rival: Explanation, other: str) -> None:
    told = reason(Name(0.99, fit(ratio=1.0123), fit(rival, ratio=2.5)))
    assert told == (
        "Pulled to the recording, a simulation with it errs by 1.01 times the noise, without it by 2.5 times at best"
        f" ({other})."
    )


def test_what_is_not_sure_enough_is_told_with_its_probability() -> None:
    unsure = [
        Doubted(id=effect, confidence=sure, explanation="")
        for effect, sure in (("drag", 0.97), ("backlash", 0.43), ("sensor_lag", 0.081))
    ]
    text = said("unexplained", left=LEFT, unsure=unsure)
    assert text.startswith(
        "An error remains that no effect explains. Sure enough by itself, but not needed beside the rest: drag (97 %). "
        "Not sure enough to be named: backlash (43 %), sensor lag (8.1 %). "
        "What remains is a torque that grows with the square of the speed. "
    )
    assert "Not sure" not in said("unexplained", left=LEFT)


def test_the_headline_says_what_cannot_be_told_apart_and_not_the_first_of_it() -> None:
    text = said("missing_physics", [TIED])
    assert text.startswith(
        "The model lacks viscous friction, or armature resistance and torque constant together, which fit alike. "
    )
    text = said("parameter_drift", parameters={"spring_preload": spring(indistinguishable_from=[["coulomb_friction"]])})
    assert "instead of 0.1, or coulomb friction, which fit alike. " in text


def test_an_effect_that_shows_beside_what_remains_is_a_part_of_it() -> None:
    text = said("unexplained", [TIED], left=LEFT)
    assert "An error remains that no effect explains. Part of it is viscous friction, or armature" in text


def test_the_mismatch_is_divided_into_shares() -> None:
    shares = Shares(0.2, {"backlash": Share(0.5, 0.7)}, 0.3)
    named = Effect(id="backlash", confidence=0.99, parameters={}, share=0.5, explanation="")
    assert divided(found(shares=shares), [named]) == [
        "Of the squared error of the model as described re-estimated parameters take 20 %, backlash 50 %, and 30 % is"
        " left."
    ]
    assert divided(found(), [named]) == []


def test_a_model_that_is_not_that_of_the_verdict_is_said() -> None:
    assert handed_out(found()) == ""
    assert "handed out is the model as described:" in handed_out(found(written=fit(Explanation())))
    one = handed_out(found(written=fit(shape={})))
    assert "handed out is one with coulomb friction + backlash and a map of the missing torque: of all" in one
    assert one.endswith("the blocks that were held out to choose (coulomb friction 0.25, backlash: gap 0.04).")


@pytest.mark.parametrize(
    ("by", "words"), [("budget", "larger --budget"), ("interrupt", "Interrupted"), ("clock", "depends on the machine")]
)
def test_a_search_that_ended_early_says_so_first(by: str, words: str) -> None:
    text = stopped(found(stopped_by=by))
    assert words in text
    assert said("consistent", stopped_by=by).startswith(text)
    assert stopped(found()) == ""


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("coulomb_friction", None),
        ("armature_resistance", "accounts for"),
        ("torque_constant", "do not tell it from"),
        ("gear_ratio", "does not free it"),
    ],
)
def test_a_parameter_that_was_not_fitted_says_why(name: str, why: str | None) -> None:
    told = held(name, found())
    assert told is None if why is None else why in told


def test_an_error_that_is_not_finite_is_not_known() -> None:
    assert "is not known; the noise is 0.004 V." in unseen_error(quality_of(final=float("inf")), "V")
    assert "goes from 0.1 to 0.005 V; the noise is 0.004 V." in unseen_error(quality_of(final=0.005), "V")


@pytest.mark.parametrize(
    ("ends", "when"),
    [((29.35, 34.07), "between 29.4 and 34.1 s"), ((31.71, 31.74), "at 31.7 s"), (None, "at 31.7 s")],
    ids=["at rest", "moving", "no interval"],
)
def test_a_change_is_told_with_the_moments_between_which_it_lies(ends, when) -> None:
    preload = spring(nominal=0.29, value=0.29, indistinguishable_from=[["external_load"]])
    change = Change(parameter="spring_preload", time=31.71, time_ci95=ends, before=0.29, after=0.322)
    text = said("parameter_drift", parameters={"spring_preload": preload}, changes=[change])
    assert f"spring preload changes {when} from 0.29 to 0.322, or external load, which fit alike. " in text


def test_advice_tells_ties_apart_and_shows_what_is_hidden_each_once() -> None:
    hidden = [NotTestable(id="backlash", why="", record="duty below 0")]
    limit = Limit("slow_sampling", "sampled at 60 Hz")
    steps = advice(found("missing_physics"), [TIED, TIED], {}, hidden, [limit, limit])
    assert steps[0] == limit.record
    assert steps[1].startswith("To tell viscous friction from armature resistance and torque constant: ")
    assert "measure the motor's resistance at standstill" in steps[1] and "`free: false`" in steps[1]
    assert steps[2] == "To see backlash, record: duty below 0."
    assert len(steps) == 3


def test_advice_begins_with_numbers_of_a_description_that_is_far_off() -> None:
    far = {"spring_preload": spring(at_bound=True)}
    steps = advice(found("unexplained"), [], far, [], [Limit("short", "")])
    assert steps[0].startswith("Correct spring preload in the description, where the fit ends on a bound of the search")
    assert len(steps) == 3


def test_advice_sends_nobody_to_stops_that_are_not_there() -> None:
    drifted = {"spring_preload": spring(indistinguishable_from=[["gravity_torque"]])}
    with_stops, without = (
        advice(found("parameter_drift", actuator=actuator), [], drifted, [], [])[0]
        for actuator in (PIERBURG, read_actuator("xl330"))
    )
    assert "stops" in with_stops and "stops" not in without and "by other means" in without


@pytest.mark.parametrize(
    ("limits", "show"),
    [({"input_delay": 3e-5, "sensor_lag": 2e-4, "backlash": None}, True), ({"input_delay": None}, False)],
)
def test_slow_sampling_hides_no_short_time_that_has_a_limit(limits, show) -> None:
    seen = {effect: Seen(value and Strongest(effect, "delay", value, False), 0.0) for effect, value in limits.items()}
    assert short_times_show(SimpleNamespace(seen=seen)) is show


def test_a_converters_step_is_in_the_unit_of_what_is_measured():
    actuator, choice = read_actuator("xl330"), SimpleNamespace(explained=True)
    found = SimpleNamespace(step=0.0015, data=SimpleNamespace(actuator=actuator), choice=choice)
    assert converter(found).parameters["step"].unit == "rad" and "0.0015 rad" in converter(found).explanation
    assert ruled_out(Strongest("sensor_quantization", "step", 0.001, False), found).unit == "rad"
