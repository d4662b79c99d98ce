"""Friction as (reach, offset, slope): dry up to `reach` against motion, or a bristle's offset + slope w.

Dry friction is set-valued (Karnopp with a velocity band of zero width): the implicit step finds either a
standstill that the dry part can hold or a sliding velocity it opposes. The level is taken at the velocity
before the step, which makes the step a monotone map with exactly the equilibria of the differential
equation: on a falling Stribeck curve it keeps to the right branch at any step length.
"""

from __future__ import annotations

from math import exp
from typing import Any

from pierburg_ros.kernel import kernel


@kernel
def level(p: Any, rest: float, angle: float, velocity: float, motor_torque: float) -> float:
    """Dry friction while opening or at rest [N.m]; closing adds `coulomb_difference`.

    Outside the catalogue it grows with the time at `rest` [s] (Dieterich's ageing of contacts).
    """
    torque: float = p.coulomb_friction + p.load_dependent_friction.coefficient * abs(motor_torque)
    if p.ageing_friction.growth != 0.0:
        torque *= 1.0 + p.ageing_friction.growth * (1.0 - exp(-rest / p.ageing_friction.time_constant))
    if p.static_friction.breakaway_torque > 0.0:
        excess = p.static_friction.breakaway_torque - p.coulomb_friction
        torque += excess * stribeck(velocity, p.static_friction.stribeck_velocity)
    if p.position_dependent_friction.amplitude != 0.0:
        distance = (angle - p.position_dependent_friction.center) / p.position_dependent_friction.width
        torque += p.position_dependent_friction.amplitude * exp(-distance * distance)
    return torque


@kernel
def stribeck(velocity: float, scale: float) -> float:
    """Share of the breakaway excess left at a velocity [1]; with a `scale` of 0 gone once the shaft moves."""
    if velocity == 0.0:
        return 1.0
    return exp(-((velocity / scale) ** 2))


@kernel
def solve(push: float, damping: float, dry: float, share: float, p: Any) -> float:
    """Velocity w with damping w + viscous(w) + drag(w) + dry(w) = push [rad/s]; 0 where the dry part holds the push.

    A side that carries `share` of all friction has that share of the viscous and directional terms too.
    """
    closing = dry
    if p.presliding.stiffness == 0.0:
        closing += share * p.direction_dependent_friction.coulomb_difference
    damping += share * p.viscous_friction.coefficient
    if push > dry:
        return sliding(push - dry, damping, share, p)
    if push < -closing:
        damping += share * p.direction_dependent_friction.viscous_difference
        return -sliding(-push - closing, damping, share, p)
    return 0.0


@kernel
def sliding(push: float, damping: float, share: float, p: Any) -> float:
    """Speed w [rad/s] with damping w + share (quadratic w^2 + cubic w^3) = push, by tangents from above."""
    quadratic, cubic = share * p.drag.quadratic, share * p.drag.cubic
    speed: float = push / damping
    if quadratic == 0.0 and cubic == 0.0:
        return speed
    if quadratic > 0.0:
        speed = min(speed, (push / quadratic) ** 0.5)
    if cubic > 0.0:
        speed = min(speed, (push / cubic) ** (1.0 / 3.0))
    for _ in range(30):
        left = ((cubic * speed + quadratic) * speed + damping) * speed - push
        change = left / ((3.0 * cubic * speed + 2.0 * quadratic) * speed + damping)
        speed -= change
        if change <= 1e-14 * speed:
            break
    return speed


@kernel
def resistance(p: Any, dry: float, velocity: float, deflection: float, h: float) -> tuple[float, float, float]:
    """Friction of the step as (dry, a, b): dry against motion [N.m], or presliding torque a + b w.

    a [N.m] and b [N.m.s/rad] hold for the velocity w at the end of the step.
    """
    if p.presliding.stiffness == 0.0:
        return dry, 0.0, 0.0
    wear = _wear(p, dry, velocity, h)
    stiffness = p.presliding.stiffness
    damping = p.presliding.damping
    offset = stiffness * deflection / wear + damping * (deflection / wear - deflection) / h
    return 0.0, offset, (stiffness * h + damping) / wear


@kernel
def bristle(p: Any, dry: float, deflection: float, before: float, velocity: float, h: float) -> float:
    """Bristle deflection after the step [rad]: dz/dt = w - abs(w) z stiffness / level, implicit in z."""
    return (deflection + h * velocity) / _wear(p, dry, before, h)


@kernel
def _wear(p: Any, dry: float, velocity: float, h: float) -> float:
    if velocity < 0.0:
        dry += p.direction_dependent_friction.coulomb_difference
    wear: float = 1.0 + h * abs(velocity) * p.presliding.stiffness / dry
    return wear
