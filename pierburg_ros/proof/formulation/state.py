"""What the textbook valve remembers from one step to the next."""

from __future__ import annotations

from typing import Any

import numpy as np

STATE = np.dtype(
    [
        ("time", np.float64),  # s since the first sample
        ("motor_angle", np.float64),  # rad, motor side of the gear, counted at the shaft
        ("motor_velocity", np.float64),  # rad/s
        ("angle", np.float64),  # rad, shaft
        ("velocity", np.float64),  # rad/s
        ("motor_bristle", np.float64),  # rad, presliding deflection
        ("bristle", np.float64),  # rad
        ("current", np.float64),  # A
        ("rise", np.float64),  # K above the temperature at the start
        ("magnet_angle", np.float64),  # rad, what turns before the Hall sensor
        ("sensed_angle", np.float64),  # rad, after the sensor's lag
        ("relaxed_angle", np.float64),  # rad, where the viscoelastic branch has settled
        ("time_open", np.float64),  # rad.s, angle summed over time
        ("hysteretic_torque", np.float64),  # N.m
        ("rest", np.float64),  # s since the shaft last moved
    ]
)


def initial_state(p: Any, angle: float = 0.0) -> Any:
    """State at rest at `angle` [rad]: cold, no current, opening flank touching, magnet centred.

    The bristle of `presliding` is strained as closing at a crawl leaves it: that is how the shaft got there.
    """
    state = np.zeros(1, STATE)
    for name in ("motor_angle", "angle", "magnet_angle", "sensed_angle", "relaxed_angle"):
        state[name] = angle
    stiffness = p["presliding"]["stiffness"][0]
    if stiffness > 0.0:
        dry = p["coulomb_friction"][0] + p["direction_dependent_friction"]["coulomb_difference"][0]
        state["bristle"] = state["motor_bristle"] = -dry / stiffness
    return state
