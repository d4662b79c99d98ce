"""How strong a concealed effect is drawn: from barely visible to what a technician would notice.

The ranges are wider, at the weak end, than those of a bench with one clear fault. Where a parameter cannot
be drawn alone (a load's window, one of two springs) the draw is written out below the table.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from pierburg_ros.proof.formulation.values import NOMINAL

Random = np.random.Generator
Draw = Callable[[Random], float]


def spread(low: float, high: float) -> Draw:
    """Log-uniform between two positive bounds."""
    return lambda random: float(math.exp(random.uniform(math.log(low), math.log(high))))


def even(low: float, high: float) -> Draw:
    """Uniform between two bounds."""
    return lambda random: float(random.uniform(low, high))


def one_of(*choices: float) -> Draw:
    """One of the given numbers."""
    return lambda random: float(random.choice(choices))


def either_sign(draw: Draw) -> Draw:
    """A magnitude with a random sign."""
    return lambda random: draw(random) * float(random.choice([-1.0, 1.0]))


STRENGTHS: dict[str, dict[str, Draw]] = {
    "viscous_friction": {"coefficient": spread(0.008, 0.06)},
    "static_friction": {"breakaway_torque": even(0.212, 0.285), "stribeck_velocity": spread(0.03, 0.3)},
    "presliding": {"stiffness": spread(5.0, 50.0), "damping": spread(0.005, 0.05)},
    "load_dependent_friction": {"coefficient": spread(0.02, 0.15)},
    "position_dependent_friction": {
        "amplitude": spread(0.015, 0.08),
        "center": even(0.25, 1.3),
        "width": spread(0.05, 0.3),
    },
    "backlash": {"gap": spread(0.02, 0.1), "motor_friction_share": even(0.1, 0.6)},
    "gear_compliance": {"stiffness": spread(3.0, 40.0), "damping": spread(0.003, 0.03)},
    "cogging_torque": {
        "amplitude": spread(0.008, 0.04),
        "periods_per_motor_revolution": one_of(1, 2, 3, 4, 6),
        "phase": even(0.0, 2 * math.pi),
    },
    "stop_compliance": {"stiffness": spread(6.0, 60.0), "damping": spread(0.01, 0.1)},
    "thermal_resistance": {"thermal_resistance": spread(5.0, 45.0), "heat_capacity": spread(0.15, 1.5)},
    "supply_sag": {"source_resistance": spread(0.6, 3.6)},
    "pwm_deadband": {"width": spread(0.003, 0.03)},
    "armature_inductance": {"inductance": spread(0.004, 0.04)},
    "input_delay": {"delay": spread(0.004, 0.04)},
    "sensor_lag": {"time_constant": spread(0.003, 0.025)},
    "sensor_nonlinearity": {"amplitude": either_sign(spread(0.01, 0.05)), "half_waves": one_of(1, 2)},
    "sensor_hysteresis": {"width": spread(0.004, 0.025)},
    "sensor_quantization": {"step": spread(0.01, 0.06)},
    "relaxation": {"stiffness": spread(0.02, 0.1), "time_constant": spread(0.8, 8.0)},
    "magnet_fading": {"share": spread(0.06, 0.2), "time_constant": spread(8.0, 30.0)},
    "spring_set": {"torque": spread(0.04, 0.12), "exposure": spread(8.0, 40.0)},
    "hysteretic_spring": {"stiffness": spread(0.2, 1.0), "yield_torque": spread(0.03, 0.08)},
    "detent": {"torque": spread(0.03, 0.1), "center": even(0.3, 1.2), "width": spread(0.08, 0.25)},
    "ageing_friction": {"growth": spread(0.04, 0.2), "time_constant": spread(0.5, 5.0)},
}


def strength(effect: str, random: Random) -> dict[str, float]:
    """Flat dotted values of one concealed effect."""
    special = SPECIAL.get(effect)
    drawn = special(random) if special else {name: draw(random) for name, draw in STRENGTHS[effect].items()}
    return {f"{effect}.{name}": value for name, value in drawn.items()}


def remainder(random: Random) -> dict[str, float]:
    """What always remains on a real bench, small.

    A viscoelastic branch of 5 % of the spring, and friction that grows by 4 % while the shaft rests.
    """
    return {
        "relaxation.stiffness": 0.05 * NOMINAL["spring_stiffness"],
        "relaxation.time_constant": spread(1.0, 6.0)(random),
        "ageing_friction.growth": 0.04,
        "ageing_friction.time_constant": spread(0.5, 5.0)(random),
    }


def _direction(random: Random) -> dict[str, float]:
    viscous, dry = spread(0.02, 0.1)(random), spread(0.015, 0.08)(random)
    which = random.integers(3)
    return {"viscous_difference": viscous if which != 1 else 0.0, "coulomb_difference": dry if which else 0.0}


def _drag(random: Random) -> dict[str, float]:
    quadratic, cubic = spread(0.002, 0.02)(random), spread(0.0003, 0.003)(random)
    which = random.integers(3)
    return {"quadratic": quadratic if which != 1 else 0.0, "cubic": cubic if which else 0.0}


def _spring(random: Random) -> dict[str, float]:
    if random.random() < 0.5:
        return {"cubic_stiffness": spread(0.015, 0.1)(random)}
    return {"knee_stiffness": spread(0.03, 0.2)(random), "knee_angle": even(0.3, 1.1)(random)}


def _load(random: Random) -> dict[str, float]:
    if random.random() < 0.5:
        frequency, phase = spread(0.3, 4.0)(random), even(0.0, 2 * math.pi)(random)
        return {"amplitude": spread(0.015, 0.06)(random), "frequency": frequency, "phase": phase, "end": 1e9}
    start = even(5.0, 25.0)(random)
    torque = either_sign(spread(0.015, 0.08))(random)
    return {"torque": torque, "start": start, "end": start + even(8.0, 25.0)(random)}


SPECIAL: dict[str, Callable[[Random], dict[str, float]]] = {
    "drag": _drag,
    "direction_dependent_friction": _direction,
    "nonlinear_spring": _spring,
    "external_load": _load,
}

DRIFTS: dict[str, Draw] = {
    "armature_resistance": even(1.06, 1.42),  # up to the paper's own series resistor
    "spring_preload": even(0.85, 1.2),
    "coulomb_friction": even(0.7, 1.25),
    "spring_stiffness": even(0.85, 1.2),
    "torque_constant": even(0.88, 1.06),
    "supply_voltage": even(0.92, 1.07),
}  # factors on the nominal value; those nearer to 1 than SMALLEST_DRIFT are drawn again
SMALLEST_DRIFT = 0.04


GUESSED = 4
"""Numbers of a description that are off together."""

TIED = {
    "viscous_friction": ("armature_resistance", "torque_constant", "supply_voltage"),
    "direction_dependent_friction": ("spring_preload", "coulomb_friction"),
}
"""Drifts with which the effect is exactly two drifts: such a trial would have two right answers."""


def drift(random: Random, effect: str = "") -> tuple[str, float]:
    """A base parameter and the factor it has drifted by, beside an effect that it does not hide entirely."""
    name = str(random.choice([name for name in DRIFTS if name not in TIED.get(effect, ())]))
    factor = 1.0
    while abs(factor - 1.0) < SMALLEST_DRIFT:
        factor = DRIFTS[name](random)
    return name, factor


def guesses(random: Random) -> dict[str, float]:
    """The factors by which several base parameters are off: what a description guesses."""
    names = random.choice(list(DRIFTS), GUESSED, replace=False)
    return {str(name): DRIFTS[str(name)](random) for name in names}
