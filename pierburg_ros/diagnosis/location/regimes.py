"""Where in state space a mismatch is: ranges of angle, velocity, input and times in which it is concentrated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.motion import INSTANT, Motion
from pierburg_ros.diagnosis.schema import Regime

BINS = 24
"""Number of ranges of about equal time into which a variable is cut. Chosen: 4 % of the time each, finer than
`CONTRAST` requires; not varied."""
SHUFFLED_BLOCK = 5.25
"""Shortest block that stays together when the residual is shuffled, in the actuator's own time; see `block_length`.
Chosen: half a second for the valve, so that a movement stays whole; not varied."""
SHUFFLES = 250
"""Number of random orders with which a range is compared. Derived: the smallest chance they can show is 1 in 251, well
under `REPORTED_CHANCE`."""
REPORTED_CHANCE = 0.01
"""Largest chance at which a range is reported. Given: the usual 1 %."""
CONTRAST = 0.15
"""Smallest difference between share of residual and share of time at which a range is reported. Chosen: with less, it
helps nobody to look there; not varied."""
UNITS = {
    "angle": "rad",
    "velocity": "rad/s",
    "duty": "1",
    "current": "A",
    "torque": "N.m",
    "time_at_rest": "s",
    "time_since_reversal": "s",
    "time_since_start": "s",
    "stop_distance": "rad",
}
"""The variables that are tested, with their units."""


@dataclass(frozen=True)
class _Range:
    first: int
    last: int
    contrast: float


def regimes(motion: Motion, residual: Signal, seed: int = 0) -> list[Regime]:
    """The range of each variable in which `residual` is concentrated beyond chance, clearest first.

    For each variable it is the range with the largest difference between its share of the residual's energy and its
    share of time. The energy is also cut into blocks that are put in random order. `chance` is how often it is then
    concentrated as much anywhere along the same variable.
    """
    own = motion.scales.time
    place = (motion.time / (INSTANT * own)).astype(int)
    cells, first, count = np.unique(place, return_index=True, return_counts=True)
    energy = np.add.reduceat(residual**2, first)
    if not np.any(energy > 0.0):
        return []
    time = cells * INSTANT * own
    random = np.random.default_rng(seed)
    length = block_length(time, energy / count, own)
    orders = [_shuffled(time, length, random) for _ in range(SHUFFLES)]
    found = []
    for name, values in variables(motion).items():
        regime = _regime(
            name, motion.actuator.shown(UNITS[name]), values[first + count // 2], energy, count / place.size, orders
        )
        if regime is not None:
            found.append(regime)
    return sorted(found, key=lambda regime: regime.share_of_time - regime.share_of_residual)


def variables(motion: Motion) -> dict[str, Signal]:
    """Each variable by name, units in `UNITS`, shape (samples,); a stop distance only where there is a stop."""
    values = {
        "angle": motion.angle,
        "velocity": motion.velocity,
        motion.actuator.input: motion.command,
        "time_at_rest": motion.time_at_rest,
        "time_since_reversal": motion.time_since_reversal,
        "time_since_start": motion.time,
    }
    distance = motion.stop_distance
    return values if distance is None else {**values, "stop_distance": distance}


def block_length(time: Signal, energy: Signal, own: float) -> float:
    """Length [s] of blocks that keep correlated samples together: twice the correlation time of `energy`.

    It is at least `SHUFFLED_BLOCK`; `own` is the actuator's own time [s]. The length is at most a twentieth of the
    recording, or too few orders would be left.
    """
    step = 0.1 * SHUFFLED_BLOCK * own
    grid = np.arange(time[0], time[-1], step)
    series = np.interp(grid, time, energy) - float(np.mean(energy))
    spectrum = np.abs(np.fft.rfft(series, 2 * series.size)) ** 2
    correlation = np.fft.irfft(spectrum)[: series.size]
    below = np.flatnonzero(correlation < correlation[0] / np.e)
    correlated = step * float(below[0]) if below.size else float(time[-1])
    return float(np.clip(2.0 * correlated, min(SHUFFLED_BLOCK * own, time[-1] / 20.0), time[-1] / 20.0))


def _shuffled(time: Signal, length: float, random: np.random.Generator) -> NDArray[np.intp]:
    """Sample numbers with blocks of `length` [s] in random order, shape (samples,)."""
    block = (time / length).astype(int)
    rank = random.permutation(block[-1] + 1)
    return np.argsort(rank[block], kind="stable")


def _regime(
    name: str, unit: str, values: Signal, energy: Signal, weight: Signal, orders: Sequence[NDArray[np.intp]]
) -> Regime | None:
    """The range of `values` in which `energy` is concentrated, by `weight` in time.

    None where it is so by chance or not at all.
    """
    edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)))
    if edges.size < 3:
        return None
    place = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    time = np.asarray(np.bincount(place, weights=weight, minlength=edges.size - 1), dtype=float)
    best = _gathered(place, energy, time)
    if best.contrast < CONTRAST:
        return None
    exceeded = sum(_gathered(place, energy[order], time).contrast >= best.contrast for order in orders)
    chance = (1 + exceeded) / (1 + len(orders))
    if chance > REPORTED_CHANCE:
        return None
    inside = (place >= best.first) & (place <= best.last)
    return Regime(
        variable=name,
        range=(float(edges[best.first]), float(edges[best.last + 1])),
        unit=unit,
        share_of_residual=float(energy[inside].sum() / energy.sum()),
        share_of_time=float(weight[inside].sum()),
        chance=chance,
    )


def _gathered(place: NDArray[np.intp], energy: Signal, time: Signal) -> _Range:
    """The run of bins with the largest share of energy minus share of time."""
    share = np.bincount(place, weights=energy, minlength=time.size) / energy.sum()
    before = np.concatenate([[0.0], np.cumsum(share - time)])
    lowest = np.minimum.accumulate(before)
    last = int(np.argmax(before[1:] - lowest[:-1]))
    first = int(np.argmin(before[: last + 1]))
    return _Range(first, last, float(before[last + 1] - before[first]))
