"""From the input to motor torque: dead band, supply, winding, bridge. Equations (1) and (5) of the paper.

Under a current or torque drive there is no winding: the input makes the torque, whatever the velocity.
"""

from __future__ import annotations

import math

from pierburg_ros.effects import pwm_deadband, supply_sag, thermal_resistance
from pierburg_ros.effects.effect import DRIVES
from pierburg_ros.kernel import kernel

VOLTAGE = DRIVES.index("voltage")
"""The input is a duty; armature voltage = duty x supply."""
TORQUE = DRIVES.index("torque")
"""The input is the torque at the output [N.m]; else, the current of the motor [A]."""


@kernel
def switch(p, s, command, supply, closed_bridge):
    """Put `command` in force: a duty, current [A] or torque [N.m]; an open bridge carries no current at all."""
    heats = p.thermal_resistance.thermal_resistance != 0.0
    same = command == s.command and supply == s.supply and closed_bridge == s.closed_bridge
    if same and s.serial == p.serial and not heats:
        return
    s.command, s.supply, s.closed_bridge, s.serial = command, supply, closed_bridge, p.serial
    if not closed_bridge:
        s.voltage = s.drive = s.braking = s.current = 0.0
        return
    if p.drive != VOLTAGE:
        s.drive = command * (p.torque_scale if p.drive == TORQUE else p.gear_ratio * p.torque_constant)
        return
    effective = pwm_deadband.effective(p.pwm_deadband, command)
    s.voltage = effective * supply
    s.resistance = p.armature_resistance
    if heats:
        s.resistance = thermal_resistance.resistance(
            p.thermal_resistance, p.armature_resistance, s.thermal_resistance.rise
        )
    if p.supply_sag.source_resistance != 0.0:
        s.resistance += supply_sag.resistance(p.supply_sag, effective)
    constant = p.gear_ratio * p.torque_constant
    per_voltage = constant / s.resistance
    s.drive = s.voltage * per_voltage
    s.braking = constant * per_voltage


@kernel
def motor_torque(p, s, velocity):
    """Motor torque at the shaft side of the gear [N.m], at motor-side `velocity` [rad/s]: k_g k_m i."""
    if p.armature_inductance.inductance != 0.0:
        return p.gear_ratio * p.torque_constant * s.current
    return s.drive - s.braking * velocity


@kernel
def relaxed_current(p, s, duration):
    """Current [A] after `duration` [s] of standstill, with inductance."""
    if not s.closed_bridge:
        return 0.0
    final = s.voltage / s.resistance
    return final + (s.current - final) * math.exp(-s.resistance * duration / p.armature_inductance.inductance)


@kernel
def warm(p, s, travel, change, duration):
    """Heat the winding for `duration` [s] with the mean current, from the motor's `travel` [rad] and `change` [A].

    Equation (5) of the paper, averaged: voltage = R i + inductance di/dt + k_g k_m w. A winding draws
    less from a voltage as it warms, within the step too: one that holds no heat would warm and cool in turns else.
    """
    rise, power, falling = s.thermal_resistance.rise, 0.0, 0.0
    if s.closed_bridge:
        hot = thermal_resistance.resistance(p.thermal_resistance, p.armature_resistance, rise)
        source = supply_sag.resistance(p.supply_sag, pwm_deadband.effective(p.pwm_deadband, s.command))
        induced = p.gear_ratio * p.torque_constant * travel + p.armature_inductance.inductance * change
        amperes = (s.voltage - induced / duration) / (hot + source)
        power = amperes * amperes * hot
        warming = thermal_resistance.COPPER * p.armature_resistance
        falling = max(amperes * amperes * warming * (hot - source) / (hot + source), 0.0)
    s.thermal_resistance.rise = thermal_resistance.heated(p.thermal_resistance, rise, power, falling, duration)
