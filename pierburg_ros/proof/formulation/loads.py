"""Torques on the shaft besides motor and friction, positive where they close: spring, ripple, loads, stop."""

from __future__ import annotations

from math import exp, pi, sin
from typing import Any

from pierburg_ros.kernel import kernel

UPPER_STOP = pi / 2


@kernel
def spring(state: Any, p: Any) -> float:
    """Return spring [N.m], with the catalogue's stiffening and, outside it, set, relaxation, hysteresis."""
    angle = state.angle
    torque: float = p.spring_stiffness * angle + p.spring_preload
    torque += p.nonlinear_spring.cubic_stiffness * angle**3
    if angle > p.nonlinear_spring.knee_angle:
        torque += p.nonlinear_spring.knee_stiffness * (angle - p.nonlinear_spring.knee_angle)
    torque += p.relaxation.stiffness * (angle - state.relaxed_angle) + state.hysteretic_torque
    if p.spring_set.torque != 0.0:
        torque -= p.spring_set.torque * (1.0 - exp(-state.time_open / p.spring_set.exposure))
    return torque


@kernel
def external(time: float, p: Any) -> float:
    """Load from outside [N.m], constant plus pulsating, within its time window."""
    if time < p.external_load.start or time >= p.external_load.end:
        return 0.0
    torque: float = p.external_load.torque
    if p.external_load.amplitude != 0.0:
        turned = 2 * pi * p.external_load.frequency * time + p.external_load.phase
        torque += p.external_load.amplitude * sin(turned)
    return torque


@kernel
def cogging(angle: float, p: Any) -> float:
    """Reluctance ripple of the motor, counted at the shaft [N.m]."""
    if p.cogging_torque.amplitude == 0.0:
        return 0.0
    turns = p.cogging_torque.periods_per_motor_revolution * p.gear_ratio * angle
    torque: float = p.cogging_torque.amplitude * sin(turns + p.cogging_torque.phase)
    return torque


@kernel
def detent(angle: float, p: Any) -> float:
    """Magnetic notch outside the catalogue [N.m]: pulls towards its centre, most strongly one width away."""
    if p.detent.torque == 0.0:
        return 0.0
    distance = (angle - p.detent.center) / p.detent.width
    torque: float = p.detent.torque * distance * exp(0.5 - 0.5 * distance * distance)
    return torque


@kernel
def stop(state: Any, p: Any, h: float) -> tuple[float, float]:
    """Compliant stops at the end of the step as (a, b): torque a + b w [N.m], [N.m.s/rad], one-sided."""
    stiffness = p.stop_compliance.stiffness
    if stiffness == 0.0:
        return 0.0, 0.0
    depth = state.angle if state.angle < 0.0 else max(state.angle - UPPER_STOP, 0.0)
    if depth == 0.0:
        return 0.0, 0.0
    if depth * (stiffness * depth + p.stop_compliance.damping * state.velocity) < 0.0:
        return 0.0, 0.0
    return stiffness * depth, stiffness * h + p.stop_compliance.damping


@kernel
def remember(state: Any, p: Any, h: float) -> None:
    """Carry the memories of the physics outside the catalogue over one step."""
    if p.relaxation.stiffness != 0.0:
        share = h / (p.relaxation.time_constant + h)
        state.relaxed_angle += share * (state.angle - state.relaxed_angle)
    if p.ageing_friction.growth != 0.0:
        state.rest = state.rest + h if state.velocity == 0.0 else 0.0
    if p.spring_set.torque != 0.0:
        state.time_open += h * max(state.angle, 0.0)
    if p.hysteretic_spring.stiffness != 0.0:
        torque = state.hysteretic_torque + h * p.hysteretic_spring.stiffness * state.velocity
        bound = p.hysteretic_spring.yield_torque
        state.hysteretic_torque = min(max(torque, -bound), bound)
