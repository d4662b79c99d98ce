"""One step of the mechanics, implicit in velocity: one body, or motor and massless shaft with a gear between.

Torque balance of the single body: J (w - w0) / h = motor(w) - spring - loads - friction(w), solved for w;
where the dry friction can hold the rest, w = 0 exactly. All inertia is the motor's (section 7 of docs/contract.md).
"""

from __future__ import annotations

from typing import Any

from pierburg_ros.kernel import kernel
from pierburg_ros.proof.formulation.friction import bristle, level, resistance, solve
from pierburg_ros.proof.formulation.loads import UPPER_STOP, cogging, detent, external, spring, stop

TOUCHING = 1e-12  # rad, flanks nearer than this are in contact


@kernel
def at_stop(angle: float, velocity: float, p: Any, h: float) -> float:
    """Velocity with which the shaft ends the step no further than a rigid stop [rad/s]."""
    if p.stop_compliance.stiffness > 0.0:
        return velocity
    after = angle + h * velocity
    if after < 0.0:
        return -angle / h
    if after > UPPER_STOP:
        return (UPPER_STOP - angle) / h
    return velocity


@kernel
def settle(state: Any, p: Any, velocity: float, dry: float, h: float) -> None:
    """Move the shaft by one step; on a rigid stop it stands."""
    held = at_stop(state.angle, velocity, p, h)
    if p.presliding.stiffness > 0.0:
        state.bristle = bristle(p, dry, state.bristle, state.velocity, held, h)
    state.angle += h * held
    state.velocity = held if held == velocity else 0.0


@kernel
def shaft_load(state: Any, p: Any, h: float) -> tuple[float, float]:
    """All that closes the shaft but friction and motor, as (a, b): a + b w [N.m], [N.m.s/rad]."""
    stopping, stop_slope = stop(state, p, h)
    torque = spring(state, p) + external(state.time, p) + detent(state.angle, p) + stopping
    return torque, h * p.spring_stiffness + stop_slope


@kernel
def single_body(state: Any, p: Any, torque: float, damping: float, h: float) -> None:
    """Step motor and shaft as one under the motor torque `torque - damping w`."""
    load, load_slope = shaft_load(state, p, h)
    dry = level(p, state.rest, state.angle, state.velocity, torque - damping * state.velocity)
    reach, offset, slope = resistance(p, dry, state.velocity, state.bristle, h)
    inertia = p.total_inertia / h
    push = inertia * state.velocity + torque - load - cogging(state.angle, p) - offset
    velocity = solve(push, inertia + damping + load_slope + slope, reach, 1.0, p)
    settle(state, p, velocity, dry, h)
    state.motor_velocity = state.velocity
    state.motor_bristle = state.bristle


@kernel
def motor_alone(
    state: Any, p: Any, torque: float, damping: float, passed: float, passed_slope: float, h: float
) -> float:
    """Velocity of the motor side [rad/s] while the gear takes `passed + passed_slope w` from it."""
    share = p.backlash.motor_friction_share if p.backlash.gap > 0.0 else 0.0
    dry = level(p, state.rest, state.motor_angle, state.motor_velocity, torque - damping * state.motor_velocity)
    reach, offset, slope = resistance(p, dry, state.motor_velocity, state.motor_bristle, h)
    inertia = p.total_inertia / h
    push = inertia * state.motor_velocity + torque - cogging(state.motor_angle, p) - share * offset - passed
    return solve(push, inertia + damping + share * slope + passed_slope, share * reach, share, p)


@kernel
def shaft_alone(state: Any, p: Any, motor_torque: float, passed: float, passed_slope: float, h: float) -> float:
    """Velocity of the massless shaft [rad/s] while the gear gives it `passed - passed_slope w`."""
    share = 1.0 - p.backlash.motor_friction_share if p.backlash.gap > 0.0 else 1.0
    load, load_slope = shaft_load(state, p, h)
    dry = level(p, state.rest, state.angle, state.velocity, motor_torque)
    reach, offset, slope = resistance(p, dry, state.velocity, state.bristle, h)
    push = passed - load - share * offset
    return solve(push, load_slope + share * slope + passed_slope, share * reach, share, p)


@kernel
def advance_sides(state: Any, p: Any, motor_velocity: float, velocity: float, motor_torque: float, h: float) -> None:
    """Move both sides of the gear, each with its own bristle."""
    if p.presliding.stiffness > 0.0:
        dry = level(p, state.rest, state.motor_angle, state.motor_velocity, motor_torque)
        state.motor_bristle = bristle(p, dry, state.motor_bristle, state.motor_velocity, motor_velocity, h)
    state.motor_angle += h * motor_velocity
    state.motor_velocity = motor_velocity
    settle(state, p, velocity, level(p, state.rest, state.angle, state.velocity, motor_torque), h)


@kernel
def rigid_flanks(state: Any, p: Any, torque: float, damping: float, h: float) -> None:
    """Gear with play between rigid flanks: each side moves alone unless the flanks would enter each other."""
    motor_velocity = motor_alone(state, p, torque, damping, 0.0, 0.0, h)
    motor_torque = torque - damping * state.motor_velocity
    velocity = at_stop(state.angle, shaft_alone(state, p, motor_torque, 0.0, 0.0, h), p, h)
    apart = state.angle - state.motor_angle
    after = apart + h * (velocity - motor_velocity)
    if 0.0 <= after <= p.backlash.gap:
        advance_sides(state, p, motor_velocity, velocity, motor_torque, h)
        return
    flank = 0.0 if after < 0.0 else p.backlash.gap
    if abs(apart - flank) < TOUCHING:
        state.velocity = state.motor_velocity
        single_body(state, p, torque, damping, h)
    else:
        meeting = state.motor_angle + h * motor_velocity + flank
        advance_sides(state, p, motor_velocity, (meeting - state.angle) / h, motor_torque, h)
        state.velocity = state.motor_velocity
    state.motor_angle = state.angle - flank


@kernel
def deflection(state: Any, p: Any) -> tuple[float, bool]:
    """Twist of the elastic gear [rad] and whether its flanks touch."""
    twist = state.motor_angle - state.angle
    if p.backlash.gap == 0.0 or twist > 0.0:
        return twist, True
    if twist < -p.backlash.gap:
        return twist + p.backlash.gap, True
    return 0.0, False


@kernel
def elastic_gear(state: Any, p: Any, torque: float, damping: float, h: float) -> None:
    """Elastic gear, with play where there is a gap: motor and shaft in turn, twice."""
    twist, touching = deflection(state, p)
    held = p.gear_compliance.stiffness * twist
    slope = p.gear_compliance.stiffness * h + p.gear_compliance.damping
    relative = state.motor_velocity - state.velocity
    if p.backlash.gap > 0.0 and (not touching or twist * (held + p.gear_compliance.damping * relative) < 0.0):
        held, slope = 0.0, 0.0
    motor_torque = torque - damping * state.motor_velocity
    velocity = state.velocity
    motor_velocity = state.motor_velocity
    for _ in range(2):
        motor_velocity = motor_alone(state, p, torque, damping, held - slope * velocity, slope, h)
        passed = held + slope * motor_velocity
        velocity = at_stop(state.angle, shaft_alone(state, p, motor_torque, passed, slope, h), p, h)
    if slope == 0.0:
        free = state.angle + h * velocity - state.motor_angle - h * motor_velocity
        velocity -= (free - min(max(free, 0.0), p.backlash.gap)) / h
    advance_sides(state, p, motor_velocity, velocity, motor_torque, h)


@kernel
def move(state: Any, p: Any, torque: float, damping: float, h: float) -> None:
    """Advance angles and velocities by one step under the motor torque `torque - damping w`."""
    if p.gear_compliance.stiffness > 0.0:
        elastic_gear(state, p, torque, damping, h)
    elif p.backlash.gap > 0.0:
        rigid_flanks(state, p, torque, damping, h)
    else:
        single_body(state, p, torque, damping, h)
        state.motor_angle = state.angle
