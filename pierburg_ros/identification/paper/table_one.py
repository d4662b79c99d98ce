"""What the rows of the paper's Table I imply about each other; every number is computed from its rows."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.plant import Model

PRINTED = {"gain": 0.4363, "damping_ratio": 137.68, "natural_frequency": 240.16}
"""K [rad/V], xi and omega_n [rad/s]. Given: Table I of the paper."""
SMALLEST_MOVING_STEP = 0.20
"""Duty of the smallest step, which moves the shaft. Given: Fig. 4 of the paper."""
LARGEST_FREE_STEP = 0.24
"""Duty of the largest step, which stays off the stop as far as its picture shows. Given: Fig. 4 of the paper."""
SAMPLE_PERIOD = 0.002
"""Sample period of the recordings [s]. Given: 500 Hz, the rate of plant and controller."""


@dataclass(frozen=True)
class Derived:
    """The numbers that the primitive rows (R, k_g, k_m, k_s, J_t, preload, friction) imply.

    K [rad/V], xi, omega_n [rad/s], the poles [rad/s], `inertia_time` J_t / b [s], armature voltages [V] that overcome
    friction and preload, and the supply voltages [V] between which the steps of Fig. 4 make sense.
    """

    gain: float
    damping_ratio: float
    natural_frequency: float
    slow_pole: float
    fast_pole: float
    inertia_time: float
    coulomb_voltage: float
    preload_voltage: float
    supply_low: float
    supply_high: float


@dataclass(frozen=True)
class Check:
    """One statement of the audit: the printed value, the value that follows from other rows, and the verdict."""

    row: str
    printed: str
    follows: str
    verdict: str


def derive(model: Model) -> Derived:
    """K, xi, omega_n, poles and the supply voltage that Fig. 4 allows, of a spring-loaded model."""
    value = model.values
    resistance, stiffness, inertia = (
        value[name] for name in ("armature_resistance", "spring_stiffness", "total_inertia")
    )
    constant = value["gear_ratio"] * value["torque_constant"]
    braking = constant**2 / resistance
    natural = math.sqrt(stiffness / inertia)
    damping = 0.5 * natural * braking / stiffness
    fast = natural * (damping + math.sqrt(damping**2 - 1.0))
    volts = resistance / constant
    coulomb, preload = volts * value["coulomb_friction"], volts * value["spring_preload"]
    travel = volts * stiffness * math.pi / 2
    return Derived(
        constant / (resistance * stiffness),
        damping,
        natural,
        natural**2 / fast,
        fast,
        inertia / braking,
        coulomb,
        preload,
        (coulomb + preload) / SMALLEST_MOVING_STEP,
        (coulomb + preload + travel) / LARGEST_FREE_STEP,
    )


def audit(model: Model) -> tuple[Check, ...]:
    """The statements of the audit for the nominal valve."""
    d = derive(model)
    return (*_rows(d), _static_rows(d), *_inertia(d), *_equations(d), _supply(d))


def _rows(d: Derived) -> tuple[Check, ...]:
    ratio = d.gain / PRINTED["gain"]
    return (
        Check(
            "omega_n",
            f"{PRINTED['natural_frequency']:g} rad/s",
            f"sqrt(k_s / J_t) = {d.natural_frequency:.2f} rad/s",
            f"follows from k_s and J_t ({_difference(d.natural_frequency, PRINTED['natural_frequency'])})",
        ),
        Check(
            "xi",
            f"{PRINTED['damping_ratio']:g}",
            f"omega_n (k_m k_g)^2 / (2 R k_s) = {d.damping_ratio:.2f}",
            f"follows from R, k_g, k_m, k_s, J_t ({_difference(d.damping_ratio, PRINTED['damping_ratio'])})",
        ),
        Check(
            "K",
            f"{PRINTED['gain']:g} rad/V ({math.degrees(PRINTED['gain']):.1f} degrees/V)",
            f"k_g k_m / (R k_s) = {d.gain:.4f} rad/V ({math.degrees(d.gain):.1f} degrees/V)",
            f"does not follow: it is {ratio:.3f} times the printed value. K, xi and omega_n are derived; the"
            " primitive rows are the plant",
        ),
    )


def _static_rows(d: Derived) -> Check:
    return Check(
        "T_slip and preload",
        "0.2007 N.m, 0.29 N.m",
        f"V D_c = {d.coulomb_voltage:.4f} V, V D_pre = {d.preload_voltage:.4f} V by equation (9)",
        "consistent with any supply voltage: neither V nor D_c nor D_pre is printed",
    )


def _inertia(d: Derived) -> tuple[Check, ...]:
    return (
        Check(
            "poles",
            "nothing",
            f"p1 = {d.slow_pole:.3f} rad/s, p2 = {d.fast_pole / 1000:.1f} krad/s",
            f"p2 is {d.fast_pole / d.slow_pole:.3g} times p1: at any usable rate the valve is of first order",
        ),
        Check(
            "J_t",
            "2.4602e-06 kg.m^2",
            f"J_t / b = {1e6 * d.inertia_time:.1f} us, b = (k_g k_m)^2 / R",
            f"not identifiable: the velocity settles within {d.inertia_time / SAMPLE_PERIOD:.2%} of a sample"
            f" period of {1000 * SAMPLE_PERIOD:g} ms; omega_n and xi with it",
        ),
    )


def _equations(d: Derived) -> tuple[Check, ...]:
    growth = math.exp(d.slow_pole)
    return (
        Check(
            "equation (11)",
            "exp(p1 t), exp(p2 t)",
            f"p1 p2 = omega_n^2 > 0 and p1 + p2 = 2 xi omega_n > 0, so exp(p1 t) grows {growth:.2f}-fold in a second",
            "needs exp(-p t) for its poles to decay",
        ),
        Check(
            "equations (7), (8)",
            "T_stick,max; sgn of the zone width",
            "stick friction has the sign of the applied torque T; slip friction that of the velocity",
            "meant so; used so here",
        ),
    )


def _supply(d: Derived) -> Check:
    return Check(
        "supply voltage",
        "nothing",
        f"{d.supply_low:.3f} V < V < {d.supply_high:.3f} V",
        f"a step to {SMALLEST_MOVING_STEP:.0%} moves the shaft, one to {LARGEST_FREE_STEP:.0%} stays below"
        " 90 degrees as far as its picture shows",
    )


def _difference(derived: float, printed: float) -> str:
    return f"{abs(derived / printed - 1.0):.1g} relative to the printed one"
