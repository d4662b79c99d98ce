"""Slopes of a residual against closed forms: where it is smooth, bent, in jumps, and on a bound."""

import numpy as np
import pytest

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.slopes import JUMPS, sharp

TIME = np.linspace(0.0, 3.0, 200)
NOISE = 0.05 * np.random.default_rng(4).standard_normal(TIME.size)
FAR = (np.full(2, -10.0), np.full(2, 10.0))


def smooth(point: Signal) -> Signal:
    """A decay and a swing."""
    return np.exp(-point[0] * TIME) + np.sin(point[1] * TIME) + NOISE


def slopes_of_smooth(point: Signal) -> Signal:
    return np.column_stack([-TIME * np.exp(-point[0] * TIME), TIME * np.cos(point[1] * TIME)])


def test_where_the_residual_is_smooth_it_is_its_derivative() -> None:
    point = np.array([0.7, 2.0])
    np.testing.assert_allclose(sharp(smooth, point, FAR), slopes_of_smooth(point), atol=1e-7)


@pytest.mark.parametrize("side", [0, 1])
def test_on_a_bound_it_is_taken_from_within(side: int) -> None:
    point = np.array([0.7, 2.0])
    bounds = tuple(point if number == side else far for number, far in enumerate(FAR))

    def within(there: Signal) -> Signal:
        assert np.all((there >= bounds[0]) & (there <= bounds[1]))
        return smooth(there)

    # One-sided differences of 1e-5 leave half of the second derivative, at most 3^2 / 2, times that.
    np.testing.assert_allclose(sharp(within, point, bounds), slopes_of_smooth(point), atol=5e-5)


@pytest.mark.parametrize(("bend", "slope"), [(-2e-6, 1.0), (2e-6, -1.0)])
def test_beside_a_bend_it_is_that_of_its_own_side(bend: float, slope: float) -> None:
    """|x - bend| at 0: a difference of 1e-5 to either side would see 0.2."""
    weight = np.cos(TIME)

    def bent(point: Signal) -> Signal:
        return abs(point[0] - bend) * weight + NOISE

    found = sharp(bent, np.zeros(1), (np.full(1, -1.0), np.ones(1)))
    np.testing.assert_allclose(found[:, 0], slope * weight, atol=1e-6)


@pytest.mark.parametrize(("where", "step"), [(5e-5, JUMPS[0]), (7e-4, JUMPS[1]), (-4e-3, JUMPS[2])])
def test_what_acts_in_jumps_is_known_to_the_step_that_sees_one(where: float, step: float) -> None:
    """Its deviation, the noise over the length of the column, is that step; the column lies along the jump."""
    jump = np.where(np.arange(TIME.size) == 30, 5.0, 0.0)

    def jumping(point: Signal) -> Signal:
        return jump * float(point[0] > where) + NOISE

    column = sharp(jumping, np.zeros(1), (np.full(1, -1.0), np.ones(1)))[:, 0]
    noise = np.sqrt(np.mean(jumping(np.zeros(1)) ** 2))
    assert noise / np.linalg.norm(column) == pytest.approx(step)
    np.testing.assert_array_equal(np.flatnonzero(column), [30])
    assert column[30] > 0.0


def test_a_jump_too_small_or_too_far_leaves_the_column_as_it_is() -> None:
    """A hundredth in one sample is below the noise of 0.05; five lie beyond the widest step, 0.005."""
    one = np.where(np.arange(TIME.size) == 30, 1.0, 0.0)

    def flat(point: Signal) -> Signal:
        return one * (0.01 * float(point[0] > 5e-5) + 5.0 * float(point[0] > 0.01)) + NOISE

    found = sharp(flat, np.zeros(1), (np.full(1, -1.0), np.ones(1)))
    assert not np.any(found)
