"""The remainder beside a model in words: with which variable it varies, and how long it lasts."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.motion import Motion, motion_of
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.discrepancy import Discrepancy
from pierburg_ros.estimation.likelihood import SIGNIFICANT, structure
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model

BINS = 16
"""Number of ranges of equal time into which a variable is cut. Chosen: a shape with eight half waves still shows; not
varied."""
BLOCK = 21.0
"""Length of the blocks that are put in random order, in the actuator's own time. Chosen: 2 s for the valve, longer than
its memory; not varied."""
ORDERS = 30
"""Number of random orders that give what a variable explains by chance. Work: a mean of 30 is known to a fifth of their
spread."""
CLEAR = 0.1
"""Smallest share of the remainder, above chance, that makes a resemblance. Chosen: with less, it helps nobody to look
there; not varied."""


def resemblance(data: Data, run: Run, residual: Signal, discrepancy: Discrepancy) -> str:
    """What a residual of a run (measured unit, shape (samples,)) looks like, in words.

    It names the variable over whose ranges the mean of the residual varies most, beyond its variation with the
    residual's blocks in random order.
    """
    if rms(residual) <= data.noise or structure(residual, math.hypot(data.unlike, data.rounding)) < SIGNIFICANT:
        return "nothing that is told from the noise"
    above = math.sqrt(rms(residual) ** 2 - data.noise**2)
    size = f"{above:.2g} {data.actuator.unit}"
    motion = motion_of(run, data.actuator, data.noise)
    shares = {
        name: _beyond_chance(values, residual, (run.time - run.time[0]) / data.scales.time)
        for name, values in _variables(motion, data).items()
    }
    name, share = max(shares.items(), key=lambda pair: pair[1])
    reach = math.degrees(discrepancy.reach * data.noise * data.angle_per_unit)
    lasting = f"about {size} that lasts for {discrepancy.memory:.2g} s at rest and for {reach:.3g} degrees of movement"
    if share < CLEAR:
        return f"{lasting}; it goes with none of angle, velocity, input, turns of the motor, reversals and time"
    return f"{lasting}; {100.0 * share:.0f} % of it goes with {name}"


def _variables(motion: Motion, data: Data) -> dict[str, Signal]:
    """The variables with which a remainder may vary, by name in a sentence, shape (samples,)."""
    turns = Model.nominal(data.actuator).values.get("gear_ratio", 1.0) * motion.angle / (2.0 * math.pi)
    direction = np.where(motion.moving, motion.direction, 0.0)
    return {
        "the angle": motion.angle,
        "the velocity": motion.velocity,
        "the direction of movement": direction,
        f"the {data.actuator.input}": motion.command,
        "the turn of the motor": np.asarray(turns % 1.0),
        "the time since the last reversal": motion.time_since_reversal,
        "the time at rest": motion.time_at_rest,
        "the time since the start": motion.time,
    }


def _beyond_chance(values: Signal, residual: Signal, time: Signal) -> float:
    """Share of the residual's variance that its means over ranges of a variable hold, minus the share by chance.

    `time` is in units of the actuator's own time.
    """
    edges = np.unique(np.quantile(values, np.linspace(0.0, 1.0, BINS + 1)[1:-1]))
    place = np.searchsorted(edges, values, side="right")
    random = np.random.default_rng(0)
    block = (time / BLOCK).astype(int)
    orders = (np.argsort(random.permutation(block[-1] + 1)[block], kind="stable") for _ in range(ORDERS))
    chance = np.mean([_held(place, residual[order]) for order in orders])
    return float((_held(place, residual) - chance) / max(1.0 - chance, 1e-9))


def _held(place: np.ndarray, residual: Signal) -> float:
    centred = residual - residual.mean()
    count = np.maximum(np.bincount(place), 1)
    total = np.bincount(place, weights=centred)
    return float(np.sum(total**2 / count) / max(float(centred @ centred), 1e-300))
