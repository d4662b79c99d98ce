"""Every effect of the contract at a plausible strength, and the same equation written out for the reference."""

from __future__ import annotations

import math
from dataclasses import dataclass

from independent.event_driven import COULOMB, Valve, spring

Values = dict[str, float]


@dataclass(frozen=True)
class Case:
    """Values of one effect, and the valve of the reference that has it."""

    name: str
    values: Values
    valve: Valve


def _contact(angle: float, velocity: float, stiffness: float, damping: float) -> float:
    if angle > math.pi / 2:
        return max(0.0, stiffness * (angle - math.pi / 2) + damping * velocity)
    return -max(0.0, -stiffness * angle - damping * velocity) if angle < 0.0 else 0.0


def _spot(angle: float) -> float:
    return 0.066 * math.exp(-(((angle - 0.98) / 0.09) ** 2))


CASES = (
    Case("viscous_friction", {"coefficient": 0.03}, Valve(viscous=lambda direction: 0.03)),
    Case(
        "drag",
        {"quadratic": 0.01, "cubic": 0.002},
        Valve(load=lambda t, a, w: spring(t, a, w) + 0.01 * w * abs(w) + 0.002 * w**3),
    ),
    Case(
        "static_friction",
        {"breakaway_torque": 0.27, "stribeck_velocity": 0.1},
        Valve(level=lambda a, w, d, m: COULOMB + (0.27 - COULOMB) * math.exp(-((w / 0.1) ** 2))),
    ),
    Case("presliding", {"stiffness": 10.0, "damping": 0.02}, Valve(bristle_stiffness=10.0, bristle_damping=0.02)),
    Case("load_dependent_friction", {"coefficient": 0.13}, Valve(level=lambda a, w, d, m: COULOMB + 0.13 * abs(m))),
    Case(
        "direction_dependent_friction",
        {"viscous_difference": 0.08, "coulomb_difference": 0.03},
        Valve(
            level=lambda a, w, d, m: COULOMB + (0.03 if d < 0 else 0.0),
            viscous=lambda direction: 0.08 if direction < 0 else 0.0,
        ),
    ),
    Case(
        "position_dependent_friction",
        {"amplitude": 0.066, "center": 0.98, "width": 0.09},
        Valve(level=lambda a, w, d, m: COULOMB + _spot(a)),
    ),
    Case(
        "cogging_torque",
        {"amplitude": 0.028, "periods_per_motor_revolution": 3.0, "phase": 0.7},
        Valve(load=lambda t, a, w: spring(t, a, w) + 0.028 * math.sin(3.0 * 37.3 * a + 0.7)),
    ),
    Case(
        "nonlinear_spring",
        {"cubic_stiffness": 0.05, "knee_stiffness": 0.12, "knee_angle": 0.77},
        Valve(load=lambda t, a, w: spring(t, a, w) + 0.05 * a**3 + 0.12 * max(a - 0.77, 0.0)),
    ),
    Case(
        "external_load",
        {"torque": 0.03, "amplitude": 0.05, "frequency": 1.3, "phase": 0.4, "start": 1.0, "end": 9.0},
        Valve(
            load=lambda t, a, w: (
                spring(t, a, w) + (0.03 + 0.05 * math.sin(2.0 * math.pi * 1.3 * t + 0.4) if 1.0 <= t < 9.0 else 0.0)
            )
        ),
    ),
    Case(
        "stop_compliance",
        {"stiffness": 16.0, "damping": 0.03},
        Valve(stops=(-math.inf, math.inf), load=lambda t, a, w: spring(t, a, w) + _contact(a, w, 16.0, 0.03)),
    ),
    Case("supply_sag", {"source_resistance": 3.0}, Valve(source_resistance=3.0)),
    Case(
        "pwm_deadband",
        {"width": 0.012},
        Valve(effective=lambda duty: math.copysign(max(abs(duty) - 0.012, 0.0), duty)),
    ),
    Case(
        "thermal_resistance",
        {"thermal_resistance": 35.0, "heat_capacity": 0.37},
        Valve(thermal_resistance=35.0, heat_capacity=0.37),
    ),
    Case("armature_inductance", {"inductance": 0.001}, Valve(inductance=0.001)),
)
"""Effects between duty and shaft angle; transmission and sensor have tests of their own."""
