"""Other forms of the effects of an explanation: a spring that stiffens by a cube of the angle, or from an angle on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import without


def other_forms(estimator: Estimator, fit: Fit) -> Iterator[Fit]:
    """Fits of the explanation of `fit` with another form of one effect, from the start that promises most.

    The other quantities begin with their values in `fit`.
    """
    starts = starts_of(estimator.data, fit.model)
    for variant in fit.explanation.variants:
        rest = estimator.at(without(fit.explanation, variant), fit.values)
        for other in starts:
            if other.effect == variant.effect and other != variant:
                variants = tuple(other if each == variant else each for each in fit.explanation.variants)
                for _, start in promised(estimator, rest, other, starts[other])[:1]:
                    yield estimator.fit(replace(fit.explanation, variants=variants), {**rest.values, **start})
