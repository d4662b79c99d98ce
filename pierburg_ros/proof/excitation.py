"""What a trial's recording is excited with: duty sequences for open loop, setpoint sequences for closed loop.

The kinds follow a bench engineer's habits: staircase, random steps and a noise-like drive; the paper's
steps from rest; random setpoints, square waves and a sweep. Amplitudes are those that move the nominal
valve (0.18 to 0.3 of duty holds it between the stops at 13.5 V), with some runs to both stops and some
negative duty.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pierburg_ros.arrays import Signal

Random = np.random.Generator
ANGLE_LIMIT = (-0.035, 1.52)  # rad, setpoints a person gives, a little beyond the closed stop included


def _held(time: Signal, random: Random, shortest: float, longest: float, draw: Callable[[], float]) -> Signal:
    """Random levels, each held between `shortest` and `longest` [s]."""
    values = np.empty(time.size)
    start = time[0]
    while start <= time[-1]:
        end = start + random.uniform(shortest, longest)
        values[(time >= start) & (time < end)] = draw()
        start = end
    return values


def staircase(time: Signal, random: Random) -> Signal:
    """Duty up and down in equal stairs [1]."""
    top = random.uniform(0.27, 0.34)
    stairs = 2 * int(random.integers(10, 16)) + 1
    level = np.floor((time - time[0]) / (time[-1] - time[0] + 1e-9) * stairs)
    half = (stairs - 1) / 2
    return np.asarray(top * (1.0 - np.abs(level - half) / half))


def random_steps(time: Signal, random: Random) -> Signal:
    """Duty in random steps, some negative, some to the open stop [1]."""
    return _held(time, random, 1.0, 2.6, lambda: float(random.uniform(-0.12, 0.42)))


def sharp_steps(time: Signal, random: Random) -> Signal:
    """Duty in short random steps that rarely let the shaft settle [1]."""
    return _held(time, random, 0.15, 0.8, lambda: float(random.uniform(-0.05, 0.45)))


def restless(time: Signal, random: Random) -> Signal:
    """A sum of sines about the holding duty [1]."""
    duty = np.full(time.size, random.uniform(0.18, 0.23))
    for frequency in random.uniform(0.3, 3.0, 6):
        duty += random.uniform(0.02, 0.05) * np.sin(2 * np.pi * (frequency * time + random.random()))
    return duty


def paper_steps(time: Signal, random: Random) -> Signal:
    """Steps from rest to 20, 22, 24 or 26 % and back to 0, as in the paper's figure 4 [1]."""
    values = np.zeros(time.size)
    start = time[0] + random.uniform(0.3, 1.0)
    while start < time[-1]:
        end = start + random.uniform(2.0, 4.0)
        values[(time >= start) & (time < end)] = random.choice([0.20, 0.22, 0.24, 0.26])
        start = end + random.uniform(1.0, 2.5)
    return values


def duty_sequence(time: Signal, random: Random, holdout: bool) -> Signal:
    """Open-loop duty over `time` [1]: two to three recipes one after another, others for unseen data."""
    recipes: list[Callable[[Signal, Random], Signal]]
    if holdout:
        recipes = [random_steps] if random.random() < 0.5 else [paper_steps]
        recipes += [sharp_steps] if random.random() < 0.5 else []
    else:
        recipes = [staircase, random_steps, sharp_steps if random.random() < 0.5 else restless]
    parts = np.array_split(time, len(recipes))
    duty = np.concatenate([recipe(part, random) for recipe, part in zip(recipes, parts, strict=True)])
    return np.asarray(np.clip(np.round(duty, 4), -1.0, 1.0))


def random_setpoints(time: Signal, random: Random) -> Signal:
    """Setpoints at random, held 1 to 3 s [rad]."""
    return _held(time, random, 0.9, 3.0, lambda: float(random.uniform(*ANGLE_LIMIT)))


def square_wave(time: Signal, random: Random) -> Signal:
    """Setpoint to and fro between two levels, as in the paper's figure 12 [rad]."""
    low, high = random.uniform(0.1, 0.6), random.uniform(0.8, 1.45)
    return np.where(np.floor((time - time[0]) / random.uniform(1.2, 2.5)) % 2 == 0, high, low)


def sweep(time: Signal, random: Random) -> Signal:
    """Setpoint on a sine of rising frequency [rad]."""
    since = time - time[0]
    rate = random.uniform(0.005, 0.02)
    return np.asarray(0.75 + 0.55 * np.sin(2 * np.pi * (0.1 * since + 0.5 * rate * since**2)))


def setpoint_sequence(time: Signal, random: Random, holdout: bool) -> Signal:
    """Closed-loop setpoints over `time` [rad]: a second of rest, then one or two recipes."""
    recipes: list[Callable[[Signal, Random], Signal]] = [random_setpoints]
    if not holdout and random.random() < 0.7:
        recipes.append(sweep if random.random() < 0.5 else square_wave)
    parts = np.array_split(time, len(recipes))
    setpoints = np.concatenate([recipe(part, random) for recipe, part in zip(recipes, parts, strict=True)])
    setpoints[time < time[0] + 1.0] = 0.0
    return setpoints
