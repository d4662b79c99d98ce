"""The closed-form solution of x''' + a x'' + b x' + c x = constant + ramp t: motor, load and a winding that lags.

The cubic has a real root; what it leaves is a quadratic, whose responses `linear_piece` knows. The response of the
product is their partial fractions.
"""

from __future__ import annotations

import math

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.linear_piece import responses

SLOW_SERIES = 1e-5
"""Below this product of rates and step the power series is the more accurate form."""


@kernel
def real_root(a, b, c):
    """A real root of s^3 + a s^2 + b s + c: the outer one on the side where it lies alone.

    Newton's iteration from beyond the root, where the cubic bends one way, so that it cannot overshoot.
    """
    middle = -a / 3.0
    value = ((middle + a) * middle + b) * middle + c
    depressed = b - a * a / 3.0
    root = middle - math.copysign(abs(value) ** (1.0 / 3.0) + math.sqrt(max(-depressed, 0.0)), value)
    for _ in range(60):
        slope = (3.0 * root + 2.0 * a) * root + b
        if slope == 0.0:
            break
        change = (((root + a) * root + b) * root + c) / slope
        root -= change
        if abs(change) <= 1e-15 * abs(root):
            break
    return root


@kernel
def factors(a, b, c):
    """The cubic s^3 + a s^2 + b s + c as (s - root)(s^2 + p s + q): root, p, q."""
    root = real_root(a, b, c)
    if abs(root) ** 3 < abs(c):
        p = a + root
        return root, p, b + root * p
    q = -c / root if root != 0.0 else b
    return root, ((q - b) / root if root != 0.0 else a), q


@kernel
def third_responses(a, b, c, step):
    """Second and first derivative of the impulse response S, S itself, and its first two integrals, after `step` [s].

    S solves S''' + a S'' + b S' + c S = 0 with S(0) = S'(0) = 0, S''(0) = 1.
    """
    if max(abs(a) * step, abs(b) * step * step, abs(c) * step**3) < SLOW_SERIES:
        half = 0.5 * step * step
        third = half * step / 3.0
        return 1.0 - a * step + (a * a - b) * half, step - a * half, half - a * third, third, 0.25 * third * step
    root, p, q = factors(a, b, c)
    slope, impulse, integral, twice, _ = responses(p, q, step)
    reach = root * step
    grown = math.exp(reach)
    if abs(reach) < 1e-3:
        first = step * (1.0 + reach * (0.5 + reach * (1.0 / 6.0 + reach / 24.0)))
        second = step * step * (0.5 + reach * (1.0 / 6.0 + reach * (1.0 / 24.0 + reach / 120.0)))
    else:
        first = math.expm1(reach) / root
        second = (first - step) / root
    gap = (root + p) * root + q
    bend = root * root * grown + (root * p + q) * slope + root * q * impulse
    derivative = root * (grown - slope) + q * impulse
    value = grown - slope - (p + root) * impulse
    once = first - impulse - (p + root) * integral
    double = second - integral - (p + root) * twice
    return bend / gap, derivative / gap, value / gap, once / gap, double / gap
