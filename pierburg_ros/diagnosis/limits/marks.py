"""The mark that each effect could leave in the recordings: an effect that leaves none cannot be tested by them."""

from __future__ import annotations

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import largest_mark
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.workers import workers

STARTS = 4
"""Number of starts that are simulated for one way to act. Work: any start of plausible strength leaves a mark where it
can act; not varied."""


def marks(found: Found, final: Fit, jobs: int | None = None) -> dict[str, float]:
    """The largest sum of squares [noise^2] that each effect not in `final` could leave, at a plausible strength."""
    with workers(jobs) as pool:
        estimator = Estimator(found.data, found.nominal, pool.map)
        base = estimator.restated(final)
        # computed once: all projections use these slopes
        _ = base.solution.jacobian
        ways = [
            way for way in starts_of(found.data, final.model).items() if way[0].effect not in final.explanation.effects
        ]
        largest: dict[str, float] = {}
        each = pool.map(lambda way: largest_mark(estimator, base, way[0], way[1][:STARTS]), ways)
        for (variant, _starts), mark in zip(ways, each, strict=True):
            largest[variant.effect] = max(largest.get(variant.effect, 0.0), mark)
    return largest
