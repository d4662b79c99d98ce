"""The teeth of an elastic gear and the shaft that they hold: a spring and damper, and a balance of torques at once."""

from __future__ import annotations

from typing import NamedTuple

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.gear import shaft

FLOOR = 1e-4
"""Shortest time constant of the twist, as a share of the actuator's own time; stands in for a damping of 0.

Standing or sliding: teeth that damp a sliding shaft alone would send it back at once where they set it moving."""


class Grip(NamedTuple):
    """What holds the shaft: the teeth's deflection [rad], their stiffness and damping, and the shaft's own resistance.

    N.m/rad and N.m.s/rad, 0 where the teeth do not touch; N.m at rest, N.m/rad, N.m.s/rad; with its friction level
    [N.m]. `mobility` is its velocity for each N.m more [rad/(N.m.s)].
    """

    deflection: float
    stiffness: float
    damping: float
    resisting: float
    bending: float
    viscous: float
    friction: float
    mobility: float


@kernel
def _deflection(p, twist):
    """Deflection of the teeth [rad] at `twist` [rad] between motor and shaft, 0 within the play."""
    if twist > 0.0:
        return twist
    return min(twist + p.backlash.gap, 0.0)


@kernel
def holding(p, s, twist, motor_velocity, angle, velocity, bristle, time, motor):
    """What holds the shaft at `twist` [rad], last seen with this `velocity` [rad/s].

    Across a play teeth do not pull: they push the shaft until it is as fast that they let go of it.
    """
    deflection, stiffness = _deflection(p, twist), p.gear_compliance.stiffness
    damping = max(p.gear_compliance.damping, FLOOR * p.own.time * stiffness)
    if deflection != 0.0 or p.backlash.gap == 0.0:
        grip = _held(p, s, deflection, stiffness, damping, motor_velocity, angle, velocity, bristle, time, motor)
        rate = motor_velocity - shaft_velocity(s, grip, motor_velocity)
        pushes = deflection * (stiffness * deflection + p.gear_compliance.damping * rate) > 0.0
        if pushes or p.backlash.gap == 0.0:
            return grip
        loose = motor_velocity + stiffness * deflection / damping
        velocity = loose if deflection * (loose - velocity) > 0.0 else velocity
    return _held(p, s, deflection, 0.0, 0.0, motor_velocity, angle, velocity, bristle, time, motor)


@kernel
def _held(p, s, deflection, stiffness, damping, motor_velocity, angle, velocity, bristle, time, motor):
    """The same for teeth of this `stiffness` [N.m/rad] and `damping` [N.m.s/rad]."""
    if s.direction == 0.0:
        return Grip(deflection, stiffness, damping, 0.0, 0.0, 0.0, 0.0, 0.0)
    pushed = stiffness * deflection + damping * motor_velocity
    _, resisting, bending, viscous, friction = shaft.settled(
        p, s, pushed, damping, angle, velocity, bristle, time, motor
    )
    return Grip(deflection, stiffness, damping, resisting, bending, viscous, friction, 1.0 / (damping + viscous))


@kernel
def given_way(grip, more):
    """The grip after the shaft has gone a little `more` [rad]."""
    deflection, resisting = grip.deflection - more, grip.resisting + grip.bending * more
    return Grip(
        deflection,
        grip.stiffness,
        grip.damping,
        resisting,
        grip.bending,
        grip.viscous,
        grip.friction,
        grip.mobility,
    )


@kernel
def shaft_velocity(s, grip, motor_velocity):
    """Velocity of the shaft [rad/s]: where it slides its torques balance at once."""
    if s.direction == 0.0:
        return 0.0
    return grip.mobility * (grip.stiffness * grip.deflection + grip.damping * motor_velocity - grip.resisting)


@kernel
def push(grip, motor_velocity, velocity):
    """Torque from motor to shaft [N.m]."""
    return grip.stiffness * grip.deflection + grip.damping * (motor_velocity - velocity)


@kernel
def felt(s, grip):
    """Stiffness [N.m/rad] and damping [N.m.s/rad] that the motor feels, the shaft giving way."""
    if s.direction == 0.0 or grip.stiffness == 0.0:
        return grip.stiffness, grip.damping
    both = grip.stiffness + grip.bending
    stiffness = grip.stiffness * grip.bending / both if both > 0.0 else 0.0
    return stiffness, grip.damping * grip.viscous * grip.mobility
