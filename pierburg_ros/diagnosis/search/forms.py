"""Other forms of the effects of an explanation: a spring that stiffens by a cube of the angle, or from an angle on."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.explanation import without


def other_forms(estimator: Estimator, fit: Fit) -> Iterator[Fit]:
    """Fits of the explanation of `fit` with another form of one effect, from the start that promises most.

    The other quantities begin with their values in `fit`.
    """
    own, starts = fit.explanation, starts_of(estimator.data, fit.model)
    for variant, other in itertools.product(own.variants, starts):
        if other.effect != variant.effect or other == variant:
            continue
        rest = estimator.at(without(own, variant), fit.values)
        variants = tuple(other if each == variant else each for each in own.variants)
        for _, start in promised(estimator, rest, other, starts[other])[:1]:
            yield estimator.fit(replace(own, variants=variants), {**rest.values, **start})
