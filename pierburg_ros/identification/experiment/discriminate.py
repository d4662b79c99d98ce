"""Designs the duty sequence that best tells two explanations of an actuator apart.

A sequence is worth as much as is left between the two answers after each explanation has been fitted to the
other's: what refitting absorbs, no recording can show. Segments of the recipes are first combined by a linear
estimate of what is left, then the best few sequences are judged by real fits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.explanation import Explanation
from pierburg_ros.estimation.refinement import COARSEST
from pierburg_ros.identification.experiment.excitation import DUTY_RECIPES, duty_sequence
from pierburg_ros.identification.experiment.explanations import refitted_names
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.identification.fit import fit
from pierburg_ros.plant import Model

SEGMENTS = 4
"""Parts of the sequence, each of one recipe. Work: each more costs one linear estimate for every recipe and variant;
not varied."""
SEEDS = 2
"""Variants of each recipe that are tried. Work: the linear estimates grow with it; not varied."""
FINALISTS = 2
"""Sequences judged by real fits. Work: two fits each; not varied."""
COARSER = 5
"""Sample periods in one of the linear estimate, which has many sequences to try. Work: simulations and memory shrink
by it; the noise is scaled for it."""
DETECTABLE = 6.0
"""Separation [noise deviations] from which a single recording settles the question beyond doubt. Derived: noise alone
separates as far with 2e-9."""


@dataclass(frozen=True)
class Segment:
    """One part of a sequence: a recipe and the seed of its variant."""

    recipe: str
    seed: int


@dataclass(frozen=True)
class Design:
    """The sequence found: its duty at `time` [s], its segments, and how far apart the explanations remain.

    `left` [measured unit] is the RMS difference after refitting, the smaller of both ways round; `separation`
    is the length of that difference in deviations of the sensor noise.
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
        """Whether one such recording is expected to tell the explanations apart."""
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
    """The best sequence of `duration` [s] with duty within +-`limit`, for sensor noise of `noise` [unit]."""
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
    """Who answers and who is fitted to that: both ways round, but never a model to its special case."""
    ways = [(first, second), (second, first)]
    effects = [set(first.active_effects), set(second.active_effects)]
    if effects[0] < effects[1]:
        return ways[1:]
    return ways[:1] if effects[1] < effects[0] else ways


def linear_separation(first: Model, second: Model, time: Signal, duty: Signal, noise: float) -> float:
    """Estimated separation [noise deviations]: what the slopes of the second's parameters cannot absorb."""
    target = synthetic_recording(first, time, duty, noise=0.0)
    estimator = Estimator(data_of([target], second), second)
    origin = estimator.at(Explanation(refitted_names(second)))
    wide = COARSEST * estimator.coordinates(origin.explanation).steps
    difference, slopes = origin.solution.residual, estimator.slopes(origin, wide)
    lengths = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    absorbed = np.linalg.lstsq(slopes / lengths, difference, rcond=1e-6)[0]
    return float(np.linalg.norm(difference - slopes / lengths @ absorbed)) * estimator.data.noise / noise


def judge(
    first: Model, second: Model, time: Signal, duty: Signal, segments: tuple[Segment, ...], noise: float
) -> Design:
    """The design that `duty` makes, with each explanation really fitted to the other's answer."""
    left = min(
        fit(
            other,
            [synthetic_recording(truth, time, duty, noise=0.0)],
            refitted_names(other),
            starts=1,
            refine=False,
        ).rmse
        for truth, other in _ways(first, second)
    )
    answers = [synthetic_recording(model, time, duty, noise=0.0).measured for model in (first, second)]
    separation = left * float(np.sqrt(time.size)) / noise
    return Design(time, duty, segments, left, separation, answers[0], answers[1])
