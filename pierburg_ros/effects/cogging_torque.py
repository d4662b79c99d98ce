"""Cogging: the rotor prefers certain angles."""

import math

from pierburg_ros.effects.effect import Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="cogging_torque",
    stage="load",
    sentence="The motor snaps from pole to pole; the torque ripples along the travel.",
    equation="load torque amplitude sin(periods_per_motor_revolution gear_ratio angle + phase)",
    origin="Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. (2003), chapter 5",
    shows_in="a ripple along the angle, at low velocity",
    record="very slow ramps over the whole travel",
    parameters=(
        Parameter("amplitude", "N.m", 0.0, 2.0, (0.01, 0.06), "amplitude at the shaft"),
        Parameter(
            "periods_per_motor_revolution",
            "1",
            0.0,
            64.0,
            (1.0, 12.0),
            "ripple periods in one turn of the motor",
        ),
        Parameter("phase", "rad", -6.3, 6.3, (-3.15, 3.15), "phase at angle 0", default=0.0),
    ),
    strength=("amplitude",),
)


@kernel
def torque(p, gear_ratio, angle):
    """Load torque [N.m] at `angle` [rad]."""
    return p.amplitude * math.sin(p.periods_per_motor_revolution * gear_ratio * angle + p.phase)


@kernel
def slope(p, gear_ratio, angle):
    """Derivative of `torque` with respect to angle [N.m/rad]."""
    wavenumber = p.periods_per_motor_revolution * gear_ratio
    return p.amplitude * wavenumber * math.cos(wavenumber * angle + p.phase)
