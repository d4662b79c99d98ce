"""Search for other local minima around a fit: where events jump with the values, a descent ends in the nearest one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import BLOCK, CYCLE
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.evolution import evolved
from pierburg_ros.estimation.first_part import takes_time
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.estimation.prior import KNOWN
from pierburg_ros.inference.least_squares import BRIEF

REACHES = (1.0, 4.0, 12.0, 32.0)
"""Distances of the search along each axis of the cost, in standard deviations of the fit. Measured: together with
`LEAPS` and `SCAN`, 35 of n = 36 poor starts of static friction reach the noise; the values themselves were not
varied."""
LEAPS = {(-0.1, -0.05, 0.05, 0.1): 1, (-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0): 3}
"""Logarithms of the factors by which the first round moves logarithmic parameters, near and far, and from how many of
the best points found descents start. Measured: together with `REACHES` (n = 36); the values themselves were not
varied."""
SCAN = np.outer([-1.0, 1.0], np.concatenate([np.geomspace(0.002, 0.02, 8), np.linspace(0.04, 0.5, 24)])).ravel()
"""Shares by which each other parameter of the same effect is moved after a leap, since the valley bends and runs beside
a cliff. Measured: with it 35 of n = 36 poor starts of static friction reach the noise, without it 33. The 64 points are
dense where a narrow minimum may lie."""
FINEST = 1e-2
"""Smallest difference for a Jacobian, relative to the usual one. Chosen: it keeps narrow valleys passable; one that was
0.001 N.m wide was found in a trial. Not varied."""
COARSEST = 10.0
"""Largest difference for a Jacobian, relative to the usual one. Chosen: it looks across jumps of single samples; 40
times the usual one was tried on a trial of static friction (n = 1) and left it unexplained."""
ROUNDS = 6
"""Largest number of rounds of descents. Work: the search ends sooner after two rounds without a gain; not varied."""
AGAIN = 0.5
"""Share of the cost below which the search between rests starts again, if a residual remains. Chosen: a fall by half
shows that the search began in another valley; not varied."""
NEARLY = 5.0
"""Training error over noise up to which the best explanation may only have stopped too early: a population continues,
and a search does not resign. A ripple is refined if it comes so near between rests. The most likely explanation may
have stopped too early up to this multiple of the smallest error. Chosen: descents to true explanations stopped at 1.25
to 16 times the noise (n = 2 trials), one most likely at 1.9 times the smallest error. A search resigned at 1.18 times
the noise, and its truth was found 18 s later; not varied."""
POINTS = 4
"""Points of a population for each quantity. Measured: n = 3 searches with three quantities, along whole recordings of
static friction beside a drift. With 12 points, each comes from 1.12 times the noise to 1.02, where the true values are.
With 7, one of six comes to 1.03."""
GENERATIONS = 50
"""Largest number of generations of a population. Work: a search that gains comes near its end after 15 to 40; not
varied otherwise."""
SHORTEST = CYCLE * BLOCK / 2.0
"""Length of the part in which the search begins, in the actuator's own time; it doubles from part to part. Measured: n
= 16 poor starts of static friction beside a drift, in a minute of closed loop. From half a cycle of blocks (6 s) on, 15
reach the noise, from a cycle on 14, from two on 11, from whole recordings 9."""
WIDEST = 0.25
"""Largest distance of the search, as a share of a parameter's range. Chosen: an axis along which the data say nothing
would lead out of all bounds; not varied."""


def refined(estimator: Estimator, fit: Fit) -> Fit:
    """`fit`, or a better one of the same explanation, by descents from points on the axes of its cost.

    The search begins in a short part of the recordings, in which few slips can go wrong. The part grows, and each
    search begins at the better one of `fit` and what the last part has shown. Parts that `fit` accounts for are passed
    over. If an effect takes time or a parameter changes in mid-recording, whole recordings are searched at once.
    """
    explanation, found = fit.explanation, None
    late = explanation.changed is not None or any(takes_time(variant) for variant in explanation.variants)
    parts = [*([] if late else _parts(estimator)), estimator]
    for part in parts:
        begin = part.restated(fit)
        if found is not None:
            begin = min(begin, part.fit(explanation, found.values), key=lambda each: each.chi2)
        if begin.ratio > EXPLAINED or part is estimator:
            found = _searched(part, begin, leaping=found is None)
    return replace(found or fit, refined=True)


def _parts(estimator: Estimator) -> Iterator[Estimator]:
    """The same for the first part of each recording, ever longer: up to half of the first recording."""
    duration = SHORTEST * estimator.data.scales.time
    while 2.0 * duration <= estimator.data.duration:
        yield estimator.on(estimator.data.cut(duration))
        duration *= 2.0


def _searched(estimator: Estimator, fit: Fit, leaping: bool) -> Fit:
    """`fit`, or a better one of the same explanation, by descents from near and, if `leaping`, from far.

    Where the shaft rests, the search starts between its rests: far from the minimum only this cost is smooth enough.
    There a slip displaces nothing that follows. Near the noise, single slips make steps in the cost, and a population
    of points searches for the lowest.
    """
    if len(estimator.between_rests.data.runs) == len(estimator.data.runs):
        return _descended(estimator, fit, leaping)
    smooth = _descended_between_rests(estimator, fit, leaping)
    lower = _descended_from(estimator, fit, smooth)
    while lower.ratio > EXPLAINED and lower.chi2 < AGAIN * fit.chi2:
        fit = lower
        lower = _descended_from(estimator, fit, _descended_between_rests(estimator, fit, leaping=False))
    near = not adequate(lower) and lower.ratio < NEARLY
    return _evolved(estimator, lower) if near else lower


def lowered(estimator: Estimator, fit: Fit) -> Fit:
    """`fit`, or a better one of the same explanation in a minimum nearby."""
    return _descended(estimator, fit, leaping=False) if fit.explanation.names else fit


def _descended_between_rests(estimator: Estimator, fit: Fit, leaping: bool) -> Fit:
    """`fit`, or a lower one, by descents between rests."""
    rests = estimator.between_rests
    return _descended(rests, rests.fit(fit.explanation, fit.values), leaping)


def _descended_from(estimator: Estimator, fit: Fit, smooth: Fit) -> Fit:
    """The better one of `fit` and one from where `smooth` is between rests, or a lower one by descents nearby."""
    nearest = min(fit, estimator.fit(fit.explanation, smooth.values), key=lambda each: each.chi2)
    return _descended(estimator, nearest, leaping=False)


def _evolved(estimator: Estimator, fit: Fit) -> Fit:
    """`fit`, or a lower one from a population around it: one slip more or less makes a step in the cost.

    The population spreads to where chi2 has doubled, by slopes over the usual differences, and no further than usual
    deviations. Slopes over finer differences, which the last descent may have left, are those of a single step.
    """
    explanation, coordinates = fit.explanation, estimator.coordinates(fit.explanation)
    begin = estimator.restated(fit).solution
    usual = np.array([1.0 if "." in name else KNOWN for name in explanation.names])
    spread = np.linalg.inv(begin.jacobian.T @ begin.jacobian / fit.chi2 + np.diag(usual**-2.0))

    def cost(point: Signal) -> float:
        return estimator.chi2_at(explanation, coordinates.values(point))

    points = POINTS * len(explanation.names)
    lowest = evolved(cost, begin.point, spread, coordinates.bounds, points, GENERATIONS, estimator.over)
    return min(fit, estimator.fit(explanation, coordinates.values(lowest)), key=lambda each: each.chi2)


def _descended(estimator: Estimator, fit: Fit, leaping: bool) -> Fit:
    """`fit`, or the lowest fit to which rounds of descents have led.

    One descent starts at the lowest of many points. From the second round on, others start at half the longest reach
    along the weakest axis. In the first round of a `leaping` search, others start at the `_landings`. The valley of the
    cost bends, so no point on a straight line shows how low it runs there. Rounds take fine and coarse differences for
    the Jacobian in turn. The search ends when neither helps.
    """
    idle = 0
    for number in range(ROUNDS):
        axes, steps = _axes(estimator, fit), _steps(estimator, fit, coarse=number % 2 == 1)
        starts = [
            _lowest(estimator, fit, axes),
            *(_values(estimator, fit, side * REACHES[-1] * axes[0]) for side in (-0.5, 0.5) if number > 0),
        ]
        starts += _landings(estimator, fit) if leaping and number == 0 else []
        descents = [estimator.fit(fit.explanation, start, BRIEF, steps=steps) for start in starts]
        again = min(descents, key=lambda descent: descent.chi2)
        idle = idle + 1 if fit.chi2 - again.chi2 < fit.repetition else 0
        fit = again if again.chi2 <= fit.chi2 else fit
        if idle == 2:
            break
    return fit


def _landings(estimator: Estimator, fit: Fit) -> list[dict[str, float]]:
    """Starts of descents after a leap of one parameter of an effect whose cost has many local minima.

    They are the lowest points among scans of the parameters beside it.
    """
    names, landings = fit.explanation.names, []
    axes, units = estimator.coordinates(fit.explanation).axes, np.eye(len(names))
    for leaps, most in LEAPS.items():
        found = []
        for name, axis, unit in zip(names, axes, units, strict=True):
            effect = name.split(".")[0]
            beside = [i for i, other in enumerate(names) if other != name and other.split(".")[0] == effect]
            scales = [fit.solution.point[i] * units[i] for i in beside]
            for leap in leaps if axis.logarithmic and effect in EFFECT and EFFECT[effect].jumps else ():
                scans = [leap * unit + share * scale for scale in scales for share in SCAN]
                found.append(min(_measured(estimator, fit, [leap * unit, *scans]), key=lambda landing: landing[0]))
        landings += [values for _, values in sorted(found, key=lambda landing: landing[0])[:most]]
    return landings


def _measured(estimator: Estimator, fit: Fit, moves: list[Signal]) -> list[tuple[float, dict[str, float]]]:
    """The cost after each of the `moves`, and the values there."""
    places = [_values(estimator, fit, move) for move in moves]
    costs = estimator.over(partial(estimator.chi2_at, fit.explanation), places)
    return list(zip(costs, places, strict=True))


def _steps(estimator: Estimator, fit: Fit, coarse: bool) -> Signal:
    """Differences for the Jacobian: those that the data distinguish, within limits, or the largest."""
    usual = estimator.coordinates(fit.explanation).steps
    if coarse:
        return COARSEST * usual
    told_apart = np.sqrt(fit.spread / np.maximum(np.sum(fit.solution.jacobian**2, axis=0), 1e-12))
    return np.asarray(np.clip(told_apart, FINEST * usual, COARSEST * usual))


def _lowest(estimator: Estimator, fit: Fit, axes: list[Signal]) -> dict[str, float]:
    """Values at the lowest point on the axes; those of `fit` where none is lower."""
    moves = [side * axis for axis in axes for reach in REACHES for side in (-reach, reach)]
    return min([(fit.chi2, fit.values), *_measured(estimator, fit, moves)], key=lambda point: point[0])[1]


def _values(estimator: Estimator, fit: Fit, move: Signal) -> dict[str, float]:
    """Values after a `move` from `fit`, within bounds."""
    coordinates = estimator.coordinates(fit.explanation)
    return coordinates.values(np.clip(fit.solution.point + move, *coordinates.bounds))


def _axes(estimator: Estimator, fit: Fit) -> list[Signal]:
    """The axes of the cost around `fit`, the weakest first, each as long as one standard deviation along it.

    The longest reach on an axis stays within `WIDEST` of each parameter's range.
    """
    lower, upper = estimator.coordinates(fit.explanation).bounds
    jacobian = fit.solution.jacobian
    stiffness, directions = np.linalg.eigh(jacobian.T @ jacobian)
    floor = max(1e-12 * float(stiffness[-1]), 1e-12)
    found = []
    for stiff, direction in zip(stiffness, directions.T, strict=True):
        room = float(np.min(WIDEST * (upper - lower) / np.maximum(np.abs(direction), 1e-12)))
        found.append(min(np.sqrt(fit.spread / max(stiff, floor)), room / REACHES[-1]) * direction)
    return found
