"""How strong an effect that is not named may be: on a linear model the limit is known in closed form."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.found import doubtful
from pierburg_ros.diagnosis.limits import ONE_SIDED, SETTLED, WIDENED, seen
from pierburg_ros.inference.choice import Choice
from pierburg_ros.inference.evidence import EXPLAINED
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import Fitter, ladder

VISCOUS = Variant("viscous_friction", ("coefficient",))
COEFFICIENT = "viscous_friction.coefficient"
STIFF = Variant("gear_compliance", ("stiffness",), (("damping", 0.0),))
SAMPLES = 4000
RANDOM = np.random.default_rng(5)
COLUMN = RANDOM.standard_normal(SAMPLES)
PARAMETERS = np.linalg.qr(RANDOM.standard_normal((SAMPLES, 3)))[0]


@dataclass(frozen=True)
class Linear:
    """A simulation whose residual is `left`, less `slope` of a column for each unit of the effect, and parameters."""

    left: np.ndarray
    slope: float
    data: SimpleNamespace = field(
        default_factory=lambda: SimpleNamespace(train=np.ones(SAMPLES, dtype=bool), duration=60.0)
    )
    nominal = NOMINAL

    def models(self, explanation, values):
        return (values[COEFFICIENT],)

    def residual(self, strength):
        return self.left + self.slope * strength * COLUMN

    def fit(self, explanation, values, iterations=0):
        """With the parameters at their least squares."""
        moved = self.residual(values[COEFFICIENT])
        beside = moved - PARAMETERS @ (PARAMETERS.T @ moved)
        return SimpleNamespace(
            explanation=explanation,
            fitter=self,
            values=values,
            residual=beside,
            fitted=beside,
            basis=PARAMETERS,
            chi2=float(beside @ beside),
            ratio=math.sqrt(float(beside @ beside) / SAMPLES),
            repetition=1.0,
            structure=0.0,
        )


def limit_of(fit, variant=VISCOUS, starts=({"coefficient": 0.02},)):
    with ThreadPoolExecutor(1) as pool:
        return seen(fit, [(variant, list(starts))], pool)


@pytest.mark.parametrize("true", [0.0, 0.004, -0.004])
def test_the_limit_of_a_linear_model_is_the_one_of_least_squares(true):
    """One-sided 95 %: the estimate, not below zero, and 1.645 of its standard deviations."""
    noise = np.random.default_rng(8).standard_normal(SAMPLES)
    slope = 40.0
    model = Linear(noise - slope * true * COLUMN, slope)
    fit = model.fit(Explanation(), {**NOMINAL.values, COEFFICIENT: 0.0})
    beside = slope * (COLUMN - PARAMETERS @ (PARAMETERS.T @ COLUMN))
    size = float(beside @ beside)
    estimate = max(-float(beside @ noise) / size + true, 0.0)
    deviation = max(fit.ratio, 1.0) / math.sqrt(size)
    expected = estimate + math.sqrt(ONE_SIDED) * deviation
    (found,) = limit_of(fit).values()
    assert (found.limit.effect, found.limit.parameter, found.limit.above) == ("viscous_friction", "coefficient", False)
    # a strength that a fit still makes possible is raised once at most, by rounding alone
    assert (1.0 - SETTLED) * expected <= found.limit.value <= (1.0 + SETTLED) * WIDENED * expected
    assert found.mark == pytest.approx((0.02 / deviation) ** 2, rel=1e-6)


def test_what_remains_may_hide_an_effect_as_large_as_itself():
    """Noise that is five times what it should be may be the noise and an effect's, with the opposite sign."""
    noise = np.random.default_rng(8).standard_normal(SAMPLES)
    noise -= COLUMN * (COLUMN @ noise) / (COLUMN @ COLUMN)
    loud = Linear(5.0 * noise, 40.0).fit(Explanation(), {**NOMINAL.values, COEFFICIENT: 0.0})
    left, size = loud.chi2, 40.0 * float(np.linalg.norm(COLUMN - PARAMETERS @ (PARAMETERS.T @ COLUMN)))
    expected = math.sqrt(left - SAMPLES + ONE_SIDED * left / SAMPLES) / size
    found = limit_of(loud)["viscous_friction"].limit.value
    assert (1.0 - SETTLED) * expected <= found <= (1.0 + SETTLED) * WIDENED * expected


def test_what_moves_nothing_has_neither_limit_nor_mark():
    noise = np.random.default_rng(8).standard_normal(SAMPLES)
    (found,) = limit_of(Linear(noise, 0.0).fit(Explanation(), {**NOMINAL.values, COEFFICIENT: 0.0})).values()
    assert found.limit is None and found.mark < 1e-12


def test_an_effect_of_the_fit_has_no_limit():
    noise = np.random.default_rng(8).standard_normal(SAMPLES)
    fit = Linear(noise, 40.0).fit(Explanation((), (VISCOUS,)), {**NOMINAL.values, COEFFICIENT: 0.01})
    assert limit_of(fit) == {}


def test_what_is_doubted_or_tied_has_no_limit():
    ties = SimpleNamespace(ties={"viscous_friction": (("sensor_lag", "torque_constant"),)})
    choice = SimpleNamespace(doubted={"backlash": None}, alternatives=Choice.alternatives.fget(ties))
    stated = [doubtful(choice, Variant(effect, ("x",))) for effect in ("backlash", "sensor_lag", "supply_sag")]
    assert stated == [True, True, False]


CASES = [
    (Variant("sensor_lag", ("time_constant",)), "time_constant", 0.01),
    (Variant("pwm_deadband", ("width",)), "width", 0.01),
    (Variant("input_delay", ("delay",)), "delay", 0.01),
]


@pytest.fixture(scope="module")
def without() -> dict[str, float]:
    """The limits that a recording without any effect gives."""
    return {variant.effect: limit(recording({}, 12.0), variant, name, start) for variant, name, start in CASES}


def limit(made, variant: Variant, name: str, start: float) -> float | None:
    """The limit of one effect beside a fit of the two parameters that drift."""
    data = data_on(made)
    fitter = Fitter(data, NOMINAL, ladder(data)[0])
    fit = fitter.fit(Explanation(("armature_resistance", "coulomb_friction")), NOMINAL.values)
    found = limit_of(fit, variant, [{name: start}])[variant.effect].limit
    return None if found is None else found.value


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
@pytest.mark.parametrize(("variant", "name", "start"), CASES, ids=lambda value: getattr(value, "effect", ""))
def test_an_effect_that_is_there_at_half_the_limit_is_not_excluded(without, variant, name, start, seed):
    """With the limit at 1.6 of the estimate's deviations or more, half of it is excluded in one of 20 at most.

    Seeds are fixed, so that each case is one that does not.
    """
    true = 0.5 * without[variant.effect]
    found = limit(recording({f"{variant.effect}.{name}": true}, 12.0, seed), variant, name, start)
    assert found is None or found >= true


def test_what_shows_only_with_some_of_its_other_numbers_is_not_excluded_with_others():
    """Play shows nothing while the motor's friction is small beside the spring, which keeps the teeth together."""
    true = {"backlash.gap": 0.09, "backlash.motor_friction_share": 0.47}
    backlash = Variant("backlash", ("gap", "motor_friction_share"))
    starts = [{"gap": gap, "motor_friction_share": share} for gap in (0.01, 0.03, 0.05) for share in (0.1, 0.47)]
    data = data_on(recording(true, 12.0, duties=(-0.03, 0.36)))
    fit = Fitter(data, NOMINAL, ladder(data)[0]).fit(Explanation(("coulomb_friction",)), NOMINAL.values)
    assert fit.ratio < EXPLAINED
    found = limit_of(fit, backlash, starts)["backlash"].limit
    assert found is None or found.value > 0.09


def test_limits_are_far_below_what_is_plausible(without):
    """Limits that exclude nothing would pass the test above."""
    assert without["sensor_lag"] < 0.003
    assert without["pwm_deadband"] < 0.003
    assert without["input_delay"] < 0.003
