"""The fuzzy stage of Fig. 6: PI output and derivative of the error in, duty out.

Mamdani inference as Fig. 7 and Table II of the paper describe it: each input has three triangular sets N, Z,
P that differ only in their support; a rule fires with the smaller of its two memberships; rules with one
conclusion are joined by the larger; each output set is a triangle clipped at the strength of its rules; the
duty is the centre of gravity of what is left of the five. The paper prints neither the output sets nor the
implication, so these are the usual choices (min, max, centre of gravity), which scikit-fuzzy makes too.

The five output triangles are symmetric, of one common base, and narrow enough not to overlap. Their centre of
gravity is then exact in closed form and independent of that base: a triangle clipped at strength h keeps the
share h (2 - h) of its area, and its centre stays where it is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pierburg_ros.kernel import kernel

# Table II: rows are the derivative of the error N, Z, P, columns the PI output N, Z, P; the entries count the
# output sets NB, N, Z, P, PB from 0.
RULES = np.array([[0, 1, 2], [1, 2, 3], [2, 3, 4]])


@kernel
def memberships(value: float, support: float) -> tuple[float, float, float]:
    """Memberships in N, Z and P, which peak at -support, 0 and +support; beyond, N or P stays 1."""
    ratio = min(max(value / support, -1.0), 1.0)
    return max(-ratio, 0.0), 1.0 - abs(ratio), max(ratio, 0.0)


@kernel
def duty_of(settings: Any, pi_output: float, derivative: float) -> float:
    """Duty [1] that Table II gives for a PI output [V] and a derivative of the error [V/s]."""
    columns = memberships(pi_output, settings.pi_output_support)
    rows = memberships(derivative, settings.derivative_support)
    strengths = np.zeros(5)
    for row in range(3):
        for column in range(3):
            conclusion = RULES[row, column]
            strengths[conclusion] = max(strengths[conclusion], min(rows[row], columns[column]))
    areas = strengths * (2.0 - strengths)
    moment = (
        areas[0] * settings.negative_big
        + areas[1] * settings.negative
        + areas[2] * settings.zero
        + areas[3] * settings.positive
        + areas[4] * settings.positive_big
    )
    duty: float = moment / areas.sum()
    return duty


@kernel
def pi_output_for(settings: Any, duty: float, derivative: float) -> float:
    """PI output [V] within its support that gives `duty` at a derivative [V/s], or comes nearest to it."""
    low = -settings.pi_output_support
    high = settings.pi_output_support
    for _ in range(50):  # halvings: to 1e-15 of the support
        middle = 0.5 * (low + high)
        if duty_of(settings, middle, derivative) < duty:
            low = middle
        else:
            high = middle
    pi_output: float = high
    return pi_output
