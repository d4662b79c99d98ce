"""The search on functions whose minimum is known."""

import numpy as np

from pierburg_ros.closed_loop.search import search


def valley(point, at_most=np.inf):
    """Rosenbrock's function, least at (1, 1)."""
    return float((1.0 - point[0]) ** 2 + 100.0 * (point[1] - point[0] ** 2) ** 2)


def test_finds_the_bottom_of_a_curved_valley():
    found = search(valley, [(-2.0, 2.0), (-2.0, 2.0)], generations=120, members=30, seed=1)
    np.testing.assert_allclose(found.points[0], [1.0, 1.0], atol=0.02)
    assert np.all(np.diff(found.costs) >= 0.0)


def test_the_seed_repeats_the_search():
    bounds = [(-2.0, 2.0)] * 2
    first, again, other = (search(valley, bounds, 5, 8, seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.points, again.points)
    assert not np.array_equal(first.points, other.points)


def test_stays_within_its_bounds_and_tells_each_generation():
    seen, told = [], []

    def cost(point, at_most):
        seen.append(point.copy())
        return -float(point.sum())

    search(cost, [(0.0, 1.0), (5.0, 6.0)], 20, 10, on_generation=told.append)
    points = np.array(seen)
    assert np.all((points >= [0.0, 5.0]) & (points <= [1.0, 6.0]))
    assert len(told) == 20 and told == sorted(told, reverse=True)


def test_a_candidate_may_stop_counting_above_its_rival():
    def cost(point, at_most):
        return min(valley(point), at_most + 1.0)

    whole = search(valley, [(-2.0, 2.0)] * 2, 30, 12, seed=2)
    short = search(cost, [(-2.0, 2.0)] * 2, 30, 12, seed=2)
    np.testing.assert_array_equal(whole.points, short.points)
