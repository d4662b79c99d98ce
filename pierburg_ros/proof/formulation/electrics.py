"""Armature circuit: U = R i + L di/dt + k w, solved implicitly so that L = 0 is the paper's plant."""

from __future__ import annotations

from math import exp
from typing import Any

from pierburg_ros.kernel import kernel

COPPER = 0.0039  # 1/K, rise of resistance with temperature


@kernel
def effective_duty(duty: float, p: Any) -> float:
    """Duty the bridge delivers [1]: nothing below the dead band, shifted by it above."""
    width: float = p.pwm_deadband.width
    if duty > width:
        return duty - width
    if duty < -width:
        return duty + width
    return 0.0


@kernel
def resistance(state: Any, p: Any) -> float:
    """Armature resistance at the winding's present temperature [ohm]."""
    hot: float = p.armature_resistance * (1.0 + COPPER * state.rise)
    return hot


@kernel
def motor_constant(state: Any, p: Any) -> float:
    """Torque at the shaft per ampere [N.m/A], less what warm magnets have lost (outside the catalogue)."""
    constant: float = p.gear_ratio * p.torque_constant
    if p.magnet_fading.share != 0.0:
        faded = 1.0 - exp(-state.time / p.magnet_fading.time_constant)
        constant *= 1.0 - p.magnet_fading.share * faded
    return constant


@kernel
def drive(state: Any, p: Any, duty: float, supply: float, enabled: bool, h: float) -> tuple[float, float]:
    """Motor torque at the end of the step as (a, b): a - b w [N.m], [N.m.s/rad]."""
    if not enabled:
        return 0.0, 0.0
    constant = motor_constant(state, p)
    delivered = effective_duty(duty, p)
    inertance = p.armature_inductance.inductance / h
    loop = inertance + resistance(state, p) + p.supply_sag.source_resistance * delivered * delivered
    driving = inertance * state.current + delivered * supply
    return constant * driving / loop, constant * constant / loop


@kernel
def heat(state: Any, p: Any, h: float) -> None:
    """Warm the winding over one step by its own loss."""
    if p.thermal_resistance.thermal_resistance > 0.0:
        loss = state.current * state.current * resistance(state, p)
        escaping = state.rise / p.thermal_resistance.thermal_resistance
        state.rise += h * (loss - escaping) / p.thermal_resistance.heat_capacity
