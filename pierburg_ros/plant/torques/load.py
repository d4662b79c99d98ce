"""Everything that loads motor and shaft: cogging; spring, gravity, loads from outside, elastic stops, the residual."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.effects import cogging_torque, external_load, nonlinear_spring, stop_compliance
from pierburg_ros.kernel import kernel

BLURRED = 2e5
"""Thirds of a ripple's period that pass in the actuator's own time above which it may be left out: two million a
second for the valve, which at full speed passes some hundred of a ripple that its motor may have."""
UNSHAKEN = 1e-2
"""Share of its velocity by which a motor may be shaken that passes a ripple as if it were none. Its mean velocity is
then wrong by half of that where the ripple begins to be left out."""


@kernel
def ripple(p, motor_angle):
    """Load torque of the motor itself [N.m] at its angle seen from the shaft [rad]."""
    if p.cogging_torque.amplitude == 0.0:
        return 0.0
    return cogging_torque.torque(p.cogging_torque, p.gear_ratio, motor_angle)


@kernel
def blurred(p, velocity):
    """Whether a motor at this `velocity` [rad/s] passes its ripple so fast that only its mean, nothing, acts.

    No sensor sees it then, and it changes the velocity by a small share at most: amplitude / (wavenumber J w^2), of
    the energy of a ripple, amplitude / wavenumber, and the motor's own.
    """
    if abs(velocity) * p.own.time <= BLURRED * p.ripple:
        return False
    wavenumber = p.cogging_torque.periods_per_motor_revolution * p.gear_ratio
    return p.cogging_torque.amplitude < UNSHAKEN * wavenumber * p.total_inertia * velocity * velocity


@kernel
def ripple_slope(p, motor_angle):
    """Derivative of `ripple` [N.m/rad]."""
    if p.cogging_torque.amplitude == 0.0:
        return 0.0
    return cogging_torque.slope(p.cogging_torque, p.gear_ratio, motor_angle)


@kernel
def outside(p, s, time):
    """Torque [N.m] of a load from outside at `time` [s] and its rate [N.m/s]; the state keeps those of one moment."""
    if p.external_load.torque == 0.0 and p.external_load.amplitude == 0.0:
        return 0.0, 0.0
    kept = s.outside
    if kept.time != time or kept.serial != p.serial:
        kept.time, kept.serial = time, p.serial
        kept.torque, kept.rate = external_load.torque(p.external_load, time), external_load.rate(p.external_load, time)
    return kept.torque, kept.rate


@kernel
def load(p, angle, velocity, pushed):
    """Load torque of the shaft [N.m], positive closes, and its derivatives with angle, velocity and time.

    `pushed` is what comes from outside, torque [N.m] and rate [N.m/s].

    Equation (4) of the paper, T_s = k_s angle + preload, and whatever effects add.
    """
    torque = p.spring_preload + p.spring_stiffness * angle
    by_angle = p.spring_stiffness
    if p.plain:
        return torque, by_angle, 0.0, 0.0
    by_velocity = 0.0
    if p.gravity_torque != 0.0:
        torque += p.gravity_torque * math.sin(angle)
        by_angle += p.gravity_torque * math.cos(angle)
    if p.nonlinear_spring.cubic_stiffness != 0.0 or p.nonlinear_spring.knee_stiffness != 0.0:
        torque += nonlinear_spring.torque(p.nonlinear_spring, angle)
        by_angle += nonlinear_spring.slope(p.nonlinear_spring, angle)
    torque += pushed[0]
    if p.stop_compliance.stiffness != 0.0:
        stopped, stiffness, damping = contact(p, angle, velocity)
        torque += stopped
        by_angle += stiffness
        by_velocity += damping
    if p.residual.angles > 0:
        shape, slope_angle, slope_velocity = residual(p.residual, angle, velocity)
        torque += shape
        by_angle += slope_angle
        by_velocity += slope_velocity
    return torque, by_angle, by_velocity, pushed[1]


@kernel
def load_at(p, angle, velocity, time):
    """Load torque of the shaft [N.m], positive closes, at `time` [s]."""
    pushed = external_load.torque(p.external_load, time), external_load.rate(p.external_load, time)
    return load(p, angle, velocity, pushed)[0]


@kernel
def contact(p, angle, velocity):
    """Torque of the elastic stops [N.m], positive closes, with its stiffness and damping."""
    stop = p.stop_compliance
    if angle > p.upper_stop:
        torque = stop_compliance.torque(stop, angle - p.upper_stop, velocity)
    else:
        torque = -stop_compliance.torque(stop, p.lower_stop - angle, -velocity)
    if torque == 0.0:
        return 0.0, 0.0, 0.0
    return torque, stop.stiffness, stop.damping


@kernel
def residual(grid, angle, velocity):
    """Residual torque [N.m], bilinear between its nodes and clamped at its edges, with both slopes.

    With a `period` the angle begins again after it.
    """
    if grid.period > 0.0:
        angle -= grid.period * math.floor((angle - grid.angle[0]) / grid.period)
    row, along = _cell(grid.angle, grid.angles, angle)
    column, across = _cell(grid.velocity, grid.velocities, velocity)
    here, next_row = row * grid.velocities, min(row + 1, grid.angles - 1) * grid.velocities
    next_column = min(column + 1, grid.velocities - 1)
    below = grid.torque[here + column]
    rise_angle = grid.torque[next_row + column] - below
    rise_velocity = grid.torque[here + next_column] - below
    corner = grid.torque[next_row + next_column]
    twist = corner - below - rise_angle - rise_velocity
    torque = below + along * rise_angle + across * rise_velocity + along * across * twist
    slope_angle = _slope(grid.angle, grid.angles, row, angle, rise_angle + across * twist)
    slope_velocity = _slope(grid.velocity, grid.velocities, column, velocity, rise_velocity + along * twist)
    return torque, slope_angle, slope_velocity


@kernel
def _cell(nodes, count, value):
    """Index of the node below `value` and the fraction of the way to the next, clamped at the ends."""
    if count < 2 or value <= nodes[0]:
        return 0, 0.0
    if value >= nodes[count - 1]:
        return count - 2, 1.0
    index = np.searchsorted(nodes[:count], value, side="right") - 1
    return index, (value - nodes[index]) / (nodes[index + 1] - nodes[index])


@kernel
def _slope(nodes, count, index, value, rise):
    if count < 2 or value <= nodes[0] or value >= nodes[count - 1]:
        return 0.0
    return rise / (nodes[index + 1] - nodes[index])
