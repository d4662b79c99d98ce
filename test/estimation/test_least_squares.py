"""The bounded least squares: known minima, bounds, rough costs."""

import numpy as np

from pierburg_ros.estimation.least_squares import minimise

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
