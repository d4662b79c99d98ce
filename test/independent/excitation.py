"""Duty over time that moves the valve through everything it can do in a few seconds."""

from __future__ import annotations

import numpy as np

PERIOD = 0.002
"""Sample interval of a usual recording [s]."""


def rich_duty(seconds: float = 12.0, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and duty: steps onto both stops, negative duty, random steps, then a slow staircase up and down."""
    random = np.random.default_rng(seed)
    time = np.arange(round(seconds / PERIOD)) * PERIOD
    steps = [0.0, 0.24, 0.20, 0.0, -0.15, 0.0, 0.8, 0.1, -0.05, 0.22]
    steps += list(random.uniform(-0.05, 0.32, 8))
    levels = np.concatenate([np.linspace(0.17, 0.27, 12), np.linspace(0.27, 0.02, 12)])
    half = time.size // 2
    duty = np.empty(time.size)
    duty[:half] = np.asarray(steps)[np.arange(half) * len(steps) // half]
    duty[half:] = levels[np.arange(time.size - half) * levels.size // (time.size - half)]
    return time, duty
