"""Designs the duty sequence that best distinguishes two explanations of an actuator.

The value of a sequence is the difference that remains after each explanation has been fitted to the other's response:
no recording can show what refitting absorbs. The design first combines segments of the recipes by a linear estimate of
this difference. Real fits then judge the best few sequences.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.identification.experiment.excitation import DUTY_RECIPES, duty_sequence
from pierburg_ros.identification.experiment.explanations import refitted_names
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.identification.fit import climbed, fitter_of
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.evidence import rms
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fitter
from pierburg_ros.inference.least_squares import jacobian
from pierburg_ros.plant import Model

SEGMENTS = 4
"""Number of parts of the sequence, each of one recipe. Work: each more costs one linear estimate for every recipe and
variant; not varied."""
SEEDS = 2
"""Number of variants of each recipe that are tried. Work: the number of linear estimates grows with it; not varied."""
FINALISTS = 2
"""Number of sequences judged by real fits. Work: two fits each; not varied."""
COARSER = 5
"""Number of sample periods in one of the linear estimate's, which has many sequences to try. Work: simulations and
memory shrink by it; the noise is scaled for it."""
WIDE_STEPS = 10.0
"""Differences of the linear estimate's slopes, in usual ones. Chosen: they look across jumps of single samples, as when
a shaft breaks loose; not varied."""
DETECTABLE = 6.0
"""Separation [noise deviations] from which a single recording settles the question beyond doubt. Derived: noise alone
separates as far with a probability of 2e-9."""


@dataclass(frozen=True)
class Segment:
    """One part of a sequence: a recipe and the seed of its variant."""

    recipe: str
    seed: int


@dataclass(frozen=True)
class Design:
    """The sequence found: its duty at `time` [s], its segments, and the separation of the explanations.

    `left` [measured unit] is the RMS difference after refitting, the smaller of both ways round. `separation` is the
    length of that difference in standard deviations of the sensor noise.
    """

    time: Signal
    duty: Signal
    segments: tuple[Segment, ...]
    left: float
    separation: float
    first_answer: Signal
    second_answer: Signal

    @property
    def settles(self) -> bool:
        """Whether one such recording is expected to distinguish the explanations."""
        return self.separation >= DETECTABLE


def discriminate(
    first: Model,
    second: Model,
    duration: float = 60.0,
    rate: float = 500.0,
    noise: float = 0.003,
    limit: float = 1.0,
    report: Callable[[str], None] = lambda line: None,
) -> Design:
    """The best sequence of `duration` [s] with duty within +-`limit`, for a sensor noise of `noise` [measured unit]."""
    time = np.arange(round(duration * rate)) / rate
    coarse = time[::COARSER]
    segments = [Segment(recipe, seed) for recipe in DUTY_RECIPES for seed in range(SEEDS)]
    truth, other = _ways(first, second)[0]
    judged: dict[tuple[Segment, ...], float] = {}

    def estimate(chosen: tuple[Segment, ...]) -> float:
        if chosen not in judged:
            duty = _sequence(chosen, first, coarse, limit)
            judged[chosen] = linear_separation(truth, other, coarse, duty, noise / COARSER**0.5)
            report(f"{len(judged)} sequences tried, best {max(judged.values()):.1f} noise deviations")
        return judged[chosen]

    best = max(((segment,) * SEGMENTS for segment in segments), key=estimate)
    for index in range(SEGMENTS):
        best = max(((*best[:index], tried, *best[index + 1 :]) for tried in segments), key=estimate)
    finalists = sorted(judged, key=lambda chosen: -judged[chosen])[:FINALISTS]
    report(f"comparing {len(finalists)} sequences by full fits")
    designs = [judge(first, second, time, _sequence(chosen, first, time, limit), chosen, noise) for chosen in finalists]
    return max(designs, key=lambda design: design.separation)


def _sequence(segments: tuple[Segment, ...], model: Model, time: Signal, limit: float) -> Signal:
    """Duty of the segments one after another, within +-`limit` [1]."""
    edges = np.linspace(time[0], time[-1], SEGMENTS + 1)[1:-1]
    parts = np.split(time, np.searchsorted(time, edges))
    duty = [
        duty_sequence(segment.recipe, model, part, segment.seed) for segment, part in zip(segments, parts, strict=True)
    ]
    return np.clip(np.concatenate(duty), -limit, limit)


def _ways(first: Model, second: Model) -> list[tuple[Model, Model]]:
    """Pairs of a model that responds and one that is fitted: both ways round, but never a model to its special case."""
    ways = [(first, second), (second, first)]
    effects = [set(first.active_effects), set(second.active_effects)]
    if effects[0] < effects[1]:
        return ways[1:]
    return ways[:1] if effects[1] < effects[0] else ways


def linear_separation(first: Model, second: Model, time: Signal, duty: Signal, noise: float) -> float:
    """Estimated separation [noise deviations]: the difference that the second's parameters cannot absorb linearly."""
    fitter, explanation = _free(first, second, time, duty, noise), Explanation(refitted_names(second))
    coordinates = fitter.coordinates(explanation)

    def residual(point: Signal) -> Signal:
        return fitter.residual(second.with_values(in_order(coordinates.values(point), second)))

    point = coordinates.point(second.values)
    difference = residual(point)
    slopes = jacobian(residual, point, difference, *coordinates.bounds, WIDE_STEPS * coordinates.steps)
    lengths = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    absorbed = np.linalg.lstsq(slopes / lengths, difference, rcond=1e-6)[0]
    return float(np.linalg.norm(difference - slopes / lengths @ absorbed))


def _free(first: Model, second: Model, time: Signal, duty: Signal, noise: float) -> Fitter:
    """What fits the second model to the response of the first, by simulations that run free, errors in `noise`."""
    fitter = fitter_of([synthetic_recording(first, time, duty, noise=0.0)], second)
    return replace(fitter, data=replace(fitter.data, noise=noise, step=0.0, rounding=0.0), constant=math.inf)


def judge(
    first: Model, second: Model, time: Signal, duty: Signal, segments: tuple[Segment, ...], noise: float
) -> Design:
    """The design that `duty` makes, with each explanation really fitted to the other's response."""
    left = min(_left(truth, other, time, duty, noise) for truth, other in _ways(first, second))
    answers = [synthetic_recording(model, time, duty, noise=0.0).measured for model in (first, second)]
    separation = left * float(np.sqrt(time.size)) / noise
    return Design(time, duty, segments, left, separation, answers[0], answers[1])


def _left(truth: Model, other: Model, time: Signal, duty: Signal, noise: float) -> float:
    """What the other explanation leaves of the response of the `truth` [measured unit, root mean square]."""
    free, explanation = _free(truth, other, time, duty, noise), Explanation(refitted_names(other))
    near = climbed(free, explanation, other.values)
    return rms(free.fit(explanation, near.values).residual) * noise
