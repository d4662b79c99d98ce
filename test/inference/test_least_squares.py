"""The bounded least squares: known minima, bounds, rough costs."""

import numpy as np
import pytest

from pierburg_ros.inference.least_squares import minimise

STEP = np.full(2, 1e-5)


def test_reaches_the_minimum_of_rosenbrock() -> None:
    def residual(x):
        return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])

    far = np.full(2, 10.0)
    solution = minimise(residual, np.array([-1.2, 1.0]), -far, far, STEP, iterations=100, tolerance=0.0)
    assert np.allclose(solution.point, [1.0, 1.0], atol=1e-4)


def test_agrees_with_the_normal_equations_on_a_linear_problem() -> None:
    random = np.random.default_rng(1)
    matrix, wanted = random.standard_normal((40, 2)), random.standard_normal(40)
    far = np.full(2, 10.0)
    solution = minimise(lambda x: matrix @ x - wanted, np.zeros(2), -far, far, STEP)
    assert np.allclose(solution.point, np.linalg.lstsq(matrix, wanted, rcond=None)[0], atol=1e-4)


def test_a_bound_holds_and_the_other_parameter_still_moves() -> None:
    def residual(x):
        return np.array([x[0] - 3.0, x[1] - x[0] - 1.0])

    solution = minimise(residual, np.zeros(2), np.array([-5.0, -5.0]), np.array([1.0, 5.0]), STEP)
    assert solution.point[0] == 1.0
    assert abs(solution.point[1] - 2.0) < 1e-3


def test_without_parameters_it_gives_the_residual() -> None:
    nothing = np.zeros(0)
    solution = minimise(lambda _: np.array([3.0, 4.0]), nothing, nothing, nothing, nothing)
    assert solution.cost == 25.0
    assert solution.jacobian.shape == (2, 0)


def test_a_quantity_whose_bounds_coincide_stays_and_leaves_no_slope() -> None:
    def residual(x):
        return np.array([x[0] - 3.0, x[1] - x[0] - 1.0])

    lower, upper = np.array([-5.0, 0.5]), np.array([5.0, 0.5])
    solution = minimise(residual, np.array([0.0, 0.5]), lower, upper, STEP)
    # With y = 0.5 the cost (x - 3)^2 + (x + 0.5)^2 is least half way between 3 and -0.5.
    assert np.allclose(solution.point, [1.25, 0.5], atol=1e-4)
    assert solution.point[1] == 0.5
    assert np.array_equal(solution.jacobian[:, 1], [0.0, 0.0])


def test_where_every_bound_coincides_nothing_is_searched() -> None:
    asked = []

    def residual(x):
        asked.append(x)
        return x - 3.0

    solution = minimise(residual, np.zeros(2), np.ones(2), np.ones(2), STEP)
    assert np.array_equal(solution.point, [1.0, 1.0])
    assert len(asked) == 1


@pytest.mark.parametrize("iterations", [0, 1, 3, 50])
def test_the_jacobian_is_that_at_the_point_wherever_the_descent_ended(iterations: int) -> None:
    def residual(x):
        return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])

    far = np.full(2, 10.0)
    solution = minimise(residual, np.array([-1.2, 1.0]), -far, far, STEP, iterations, tolerance=0.0)
    # One-sided differences of 1e-5 are off by half the curvature, 20 / 2, times the step.
    exact = [[-20.0 * solution.point[0], 10.0], [-1.0, 0.0]]
    assert np.allclose(solution.jacobian, exact, atol=1.1e-4)
    assert np.array_equal(solution.residual, residual(solution.point))


def test_the_jacobian_on_a_bound_is_taken_from_within() -> None:
    def residual(x):
        assert np.all(x <= 1.0)
        return np.array([np.sqrt(2.0 - x[0]) - 0.1, x[1] - 2.0])

    solution = minimise(residual, np.zeros(2), np.full(2, -1.0), np.ones(2), STEP)
    assert np.array_equal(solution.point, [1.0, 1.0])
    assert np.allclose(solution.jacobian, [[-0.5, 0.0], [0.0, 1.0]], atol=1e-4)


def linear_problem():
    """A residual with its slopes and its least cost, and how often it was asked."""
    random = np.random.default_rng(2)
    matrix, wanted = random.standard_normal((40, 2)), random.standard_normal(40)
    asked = []

    def residual(x):
        asked.append(x)
        return matrix @ x - wanted

    least = float(np.linalg.lstsq(matrix, wanted, rcond=None)[1][0])
    return residual, matrix, least, asked


def test_quantities_that_are_not_told_apart_are_solved_for() -> None:
    residual, matrix, _, _ = linear_problem()
    far, step = np.full(3, 10.0), np.full(3, 1e-5)
    solution = minimise(lambda x: residual(np.array([x[0] + x[1], 0.0])), np.zeros(3), -far, far, step)
    rest = np.linalg.lstsq(matrix[:, :1], -residual(np.zeros(2)), rcond=None)[1][0]
    assert abs(solution.cost - rest) < 1e-6
