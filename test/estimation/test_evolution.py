"""The evolution strategy against minima that are known in closed form, and costs with jumps."""

import numpy as np
import pytest

from pierburg_ros.estimation.evolution import evolved

WIDE = np.full(3, -10.0), np.full(3, 10.0)


def rosenbrock(point):
    """Rosenbrock's bent valley; its minimum is 0 at (1, 1, 1)."""
    return float(np.sum(100.0 * (point[1:] - point[:-1] ** 2) ** 2 + (1.0 - point[:-1]) ** 2))


def stepped(point):
    """A bowl around (0.3, -0.2, 0.1) whose cost moves in steps: no slope anywhere."""
    return float(np.floor(1e4 * np.sum((point - [0.3, -0.2, 0.1]) ** 2)))


def test_follows_a_bent_valley():
    found = evolved(rosenbrock, np.full(3, -1.0), np.eye(3), WIDE, 24, 400, tolerance=1e-16)
    assert found == pytest.approx(np.ones(3), abs=1e-4)


def test_needs_no_slopes():
    found = evolved(stepped, np.zeros(3), np.eye(3), WIDE, 24, 100)
    assert found == pytest.approx([0.3, -0.2, 0.1], abs=0.03)


def test_learns_the_axes_of_an_ellipsoid():
    """With axes a thousand times as long as others it ends as near to the minimum."""
    long = np.array([1.0, 1e3, 1e6])
    found = evolved(lambda x: float(long @ x**2), np.ones(3), np.eye(3), WIDE, 24, 300, tolerance=1e-18)
    assert long @ found**2 < 1e-12


def test_stays_within_bounds():
    bounds = np.array([0.5, -10.0, -10.0]), np.array([10.0, 10.0, 10.0])
    seen = []

    def cost(point):
        seen.append(point)
        return float(np.sum(point**2))

    found = evolved(cost, np.full(3, 2.0), np.eye(3), bounds, 12, 60, tolerance=1e-9)
    assert np.all(np.array(seen) >= bounds[0]) and np.all(np.array(seen) <= bounds[1])
    assert found == pytest.approx([0.5, 0.0, 0.0], abs=1e-3)


def test_ends_where_nothing_differs():
    calls = []

    def flat(point):
        calls.append(point)
        return 1.0

    evolved(flat, np.zeros(2), np.eye(2), (np.full(2, -1.0), np.full(2, 1.0)), 8, 100)
    assert len(calls) == 8


def test_the_order_of_the_map_does_not_matter():
    """A generation may be computed on several cores: equal input gives equal points."""

    def backwards(function, points):
        return [*reversed([function(point) for point in reversed(points)])]

    ways = (map, backwards)
    one, other = (evolved(rosenbrock, np.zeros(3), np.eye(3), WIDE, 12, 20, over) for over in ways)
    assert np.array_equal(one, other)


def test_takes_one_quantity():
    found = evolved(lambda x: float((x[0] - 2.0) ** 2), np.zeros(1), np.eye(1), (WIDE[0][:1], WIDE[1][:1]), 8, 60)
    assert found == pytest.approx([2.0], abs=1.0)
