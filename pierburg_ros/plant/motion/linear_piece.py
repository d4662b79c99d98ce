"""The closed-form solution of one linear piece, x'' + damping x' + stiffness x = constant + ramp t.

Everything the plant does between two events is such a piece, so its step length is set by events and by
curvature, not by the fast pole (66 krad/s for the Pierburg valve).
"""

from __future__ import annotations

import math

from pierburg_ros.kernel import kernel

JUST_TURNED = 1e-2
"""A turn nearer than this [rad of the rotation] is the one that has just been passed."""
ALIKE = 1e-9
"""Steps whose lengths differ by less than this share count as one; time stamps are not exact multiples."""
SLOW = 1e-3
"""Below this product of rate and step a few terms of the power series are exact to 1e-8."""
ROOTS = 1e-8
"""Square of half the distance of the two roots, in steps, from which they count as two."""
SHORT, SOFT = 0.2, 1e-2
"""Damping and stiffness, in steps, below which the integrals come from power series: to divide by them, or by the
difference of roots that are nearly one, costs their digits."""
TERMS = 12
"""Terms of those series. Derived: the first that is left out is then below 0.25^12 / 15!, 5e-20."""


@kernel
def alike(step, other):
    """Whether two steps [s] count as one."""
    return abs(step - other) <= ALIKE * step


@kernel
def responses(damping, stiffness, step):
    """Impulse response S, its derivative, and its first three integrals, after `step` [s].

    `damping` [1/s] and `stiffness` [1/s^2] are per inertia. S solves S'' + damping S' + stiffness S = 0 with
    S(0) = 0, S'(0) = 1 (any textbook on linear differential equations).
    """
    if abs(damping) * step < SLOW and abs(stiffness) * step * step < SLOW:
        return _by_series(damping, stiffness, step)
    if abs(damping) * step < SHORT and abs(stiffness) * step * step < SOFT:
        return _by_long_series(damping, stiffness, step)
    discriminant = 0.25 * damping * damping - stiffness
    if discriminant * step * step > ROOTS:
        return _by_real_roots(damping, stiffness, step, math.sqrt(discriminant))
    return _by_rotation(damping, stiffness, step, -discriminant)


@kernel
def _by_series(damping, stiffness, step):
    first = -damping
    second = damping * damping - stiffness
    third = -damping * (damping * damping - 2.0 * stiffness)
    slope = 1.0 + step * (first + step * (second / 2.0 + step * third / 6.0))
    impulse = step * (1.0 + step * (first / 2.0 + step * (second / 6.0 + step * third / 24.0)))
    integral = step * step * (0.5 + step * (first / 6.0 + step * second / 24.0))
    twice = step * step * step * (1.0 / 6.0 + step * (first / 24.0 + step * second / 120.0))
    return slope, impulse, integral, twice, step**4 * (1.0 / 24.0 + step * first / 120.0)


@kernel
def _by_long_series(damping, stiffness, step):
    """The last two integrals term by term; the others follow from them without a division."""
    before, term = 0.0, 1.0
    twice = thrice = 0.0
    power = step * step / 2.0
    for order in range(3, 3 + TERMS):
        power *= step / order
        twice += term * power
        thrice += term * power * step / (order + 1)
        before, term = term, -damping * term - stiffness * before
    integral = 0.5 * step * step - damping * twice - stiffness * thrice
    impulse = step - damping * integral - stiffness * twice
    return 1.0 - damping * impulse - stiffness * integral, impulse, integral, twice, thrice


@kernel
def _by_real_roots(damping, stiffness, step, half_gap):
    if damping >= 0.0:
        fast = -0.5 * damping - half_gap
        slow = stiffness / fast
    else:
        slow = -0.5 * damping + half_gap
        fast = stiffness / slow
    scale = 1.0 / (slow - fast)
    grown_slow, grown_fast = math.expm1(slow * step), math.expm1(fast * step)
    slope = (slow * (grown_slow + 1.0) - fast * (grown_fast + 1.0)) * scale
    impulse = (grown_slow - grown_fast) * scale
    slow_1, slow_2, slow_3 = _integrals(slow, step, grown_slow)
    fast_1, fast_2, fast_3 = _integrals(fast, step, grown_fast)
    return slope, impulse, (slow_1 - fast_1) * scale, (slow_2 - fast_2) * scale, (slow_3 - fast_3) * scale


@kernel
def _integrals(root, step, grown):
    """The first three repeated integrals over t of exp(root t), after `step` [s]; `grown` is expm1(root step).

    Each is (previous - step^n / n!) / root, or its power series where that difference would lose digits.
    """
    reach, period = root * step, 1.0 / root
    first = grown * period if abs(reach) > 1e-12 else step * (1.0 + 0.5 * reach)
    if abs(reach) >= 1e-2:
        second = (first - step) * period
        return first, second, (second - 0.5 * step * step) * period
    square = step * step
    third = square * step * (1.0 / 6.0 + reach * (1.0 / 24.0 + reach * (1.0 / 120.0 + reach * (1.0 / 720.0))))
    if abs(reach) >= 1e-3:
        return first, (first - step) * period, third
    return first, square * (0.5 + reach * (1.0 / 6.0 + reach * (1.0 / 24.0 + reach / 120.0))), third


@kernel
def _by_rotation(damping, stiffness, step, square):
    """Roots that are one, or a pair whose imaginary part has this `square` [1/s^2]."""
    decay = math.exp(-0.5 * damping * step)
    turned = square * step * step
    if turned < ROOTS:
        sine, cosine = step * (1.0 - turned / 6.0), 1.0 - 0.5 * turned
    else:
        frequency = math.sqrt(square)
        sine, cosine = math.sin(frequency * step) / frequency, math.cos(frequency * step)
    impulse = decay * sine
    slope = decay * (cosine - 0.5 * damping * sine)
    integral = (1.0 - slope - damping * impulse) / stiffness
    twice = (step - impulse - damping * integral) / stiffness
    return slope, impulse, integral, twice, (0.5 * step * step - integral - damping * twice) / stiffness


@kernel
def turning_time(damping, stiffness, acceleration, jerk):
    """Time [s] to the next turn of the velocity, which starts with `acceleration` and `jerk`; infinite where none.

    The acceleration itself solves S'' + damping S' + stiffness S = 0, so a rotating one is zero once in half a
    period.
    """
    square = stiffness - 0.25 * damping * damping
    if square <= 0.0:
        return math.inf
    frequency = math.sqrt(square)
    phase = math.atan2(-acceleration * frequency, jerk + 0.5 * damping * acceleration)
    while phase <= JUST_TURNED:
        phase += math.pi
    return phase / frequency
