"""The moving body for simulators that want mass and place: a pendulum hangs on its lever, all else is centred."""

from __future__ import annotations

from typing import NamedTuple

from pierburg_ros.export.contents import Contents

STANDARD_GRAVITY = 9.81
"""Acceleration [m/s^2] from which a pendulum's mass and lever are made. Given: standard gravity, rounded."""
MASS = 0.02
"""Mass [kg] of a shaft that turns about its centre, where it does nothing. Chosen: as in urdf/valve.urdf."""


class Shaft(NamedTuple):
    """Mass [kg], distance of its centre below the axis [m], inertia about that centre [kg.m^2], and the axis."""

    mass: float
    lever: float
    inertia: float
    axis: str


def shaft(contents: Contents) -> Shaft:
    """The body; of a pendulum, half of the inertia is that of its mass on the lever. What slides has mass alone."""
    total = contents.base("total_inertia")
    if contents.model.actuator.motion == "linear":
        return Shaft(total, 0.0, total, "0 0 1")
    weight = contents.base("gravity_torque") / STANDARD_GRAVITY
    if weight == 0.0:
        return Shaft(MASS, 0.0, total, "0 0 1")
    lever = 0.5 * total / weight
    return Shaft(weight / lever, lever, 0.5 * total, "0 1 0")
