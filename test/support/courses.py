"""Courses of one quantity, without any recording."""

import numpy as np

from pierburg_ros.fleets.ageing.course import Course


def course(time, value, deviation, temperature=None, limited=None, unit="valve-1", quantity="armature_resistance"):
    """A course of a quantity of one unit; temperature unknown and nothing limited unless given."""
    return Course(
        unit,
        quantity,
        "ohm",
        np.asarray(time, dtype=float),
        np.asarray(value, dtype=float),
        np.asarray(deviation, dtype=float),
        np.zeros(len(time), dtype=bool) if limited is None else np.asarray(limited),
        np.full(len(time), np.nan) if temperature is None else np.asarray(temperature, dtype=float),
        4.139,
    )
