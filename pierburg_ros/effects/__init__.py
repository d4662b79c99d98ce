"""What physics exists: one file a phenomenon, listed here in the order of the signal path."""

from __future__ import annotations

from pierburg_ros.effects import (
    armature_inductance,
    backlash,
    cogging_torque,
    direction_dependent_friction,
    drag,
    external_load,
    gear_compliance,
    input_delay,
    load_dependent_friction,
    nonlinear_spring,
    position_dependent_friction,
    presliding,
    pwm_deadband,
    sensor_hysteresis,
    sensor_lag,
    sensor_nonlinearity,
    sensor_quantization,
    static_friction,
    stop_compliance,
    supply_sag,
    thermal_resistance,
    viscous_friction,
)
from pierburg_ros.effects.effect import Effect, Parameter
from pierburg_ros.effects.thermal_resistance import COPPER

EFFECTS: tuple[Effect, ...] = (
    input_delay.EFFECT,
    pwm_deadband.EFFECT,
    supply_sag.EFFECT,
    thermal_resistance.EFFECT,
    armature_inductance.EFFECT,
    backlash.EFFECT,
    gear_compliance.EFFECT,
    cogging_torque.EFFECT,
    nonlinear_spring.EFFECT,
    external_load.EFFECT,
    stop_compliance.EFFECT,
    viscous_friction.EFFECT,
    drag.EFFECT,
    static_friction.EFFECT,
    load_dependent_friction.EFFECT,
    direction_dependent_friction.EFFECT,
    position_dependent_friction.EFFECT,
    presliding.EFFECT,
    sensor_hysteresis.EFFECT,
    sensor_lag.EFFECT,
    sensor_nonlinearity.EFFECT,
    sensor_quantization.EFFECT,
)
EFFECT: dict[str, Effect] = {effect.id: effect for effect in EFFECTS}
"""By id."""
DECLARED: dict[str, Parameter] = {f"{effect.id}.{p.name}": p for effect in EFFECTS for p in effect.parameters}
"""Every parameter by dotted name."""
_QUANTITIES = {
    quantity: f"{effect.id}.{name}" for effect in EFFECTS for quantity, name in effect.elsewhere.quantities.items()
}
ADDED: dict[str, str] = {name: _QUANTITIES[p.added_to] for name, p in DECLARED.items() if p.added_to is not None}
"""What a parameter is added to and may at most cancel, by dotted names."""
GEARED: dict[str, float] = {name: p.geared for name, p in DECLARED.items() if p.geared is not None}
"""Most that a parameter may be times the gear ratio, by dotted name."""
ROUNDING: Effect = next(effect for effect in EFFECTS if effect.rounds is not None)
"""The effect of a converter."""
STEP = f"{ROUNDING.id}.{ROUNDING.rounds}"
"""Dotted name of its step."""
OUTSIDE = f"{external_load.EFFECT.id}.{external_load.EFFECT.strength[0]}"
"""Dotted name of a load torque from outside."""

__all__ = [
    "ADDED",
    "COPPER",
    "DECLARED",
    "EFFECT",
    "EFFECTS",
    "GEARED",
    "OUTSIDE",
    "ROUNDING",
    "STEP",
    "Effect",
    "Parameter",
]
