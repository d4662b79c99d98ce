"""Cogging: the rotor prefers certain angles."""

import math
from collections.abc import Mapping, Sequence

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import (
    QUADRATURE,
    Effect,
    Elsewhere,
    Motion,
    Parameter,
    Reach,
    Ripple,
    Start,
    Variant,
)
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

TURNS = (1.0, 1000.0)
"""Range in which periods per motor revolution are searched: a motor has at least one, and no motor
more than the least common multiple of its poles and slots."""
FINEST = 50_000.0
"""Most periods in one turn of the output. Chosen: a motor of 50 periods behind a gear of 1000 to 1, more than is made;
at no-load speed the simulator has eight steps for each."""
PLAUSIBLE = 12
"""Most periods per motor revolution that are plausible. Chosen: the least common multiple of the poles and slots of a
small brush motor is rarely more."""
MOST_PERIODS = 128
"""Most periods in a turn of the motor that a balance looks at. Chosen: those of a large motor without gear."""


def _every_order(reach: Reach) -> Sequence[Start]:
    """Every plausible number of periods in a turn, each at two phases in quadrature."""
    orders = range(1, MOST_PERIODS + 1)
    return [
        {"amplitude": 0.0075, "periods_per_motor_revolution": float(order), "phase": phase}
        for order in orders
        for phase in QUADRATURE
    ]


def _quarter_turn(values: Mapping[str, float]) -> float:
    """Travel [rad] over which the ripple turns once, a third of its period."""
    ripple = values["cogging_torque.periods_per_motor_revolution"] * values["gear_ratio"]
    return 2.0 / ripple if ripple > 0.0 else math.inf


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The ripple at the measured angle."""
    amplitude, periods, phase = (values[f"cogging_torque.{name}"] for name in EFFECT.names)
    sine, cosine = motion.ripple(periods * values.get("gear_ratio", 1.0))
    return amplitude * (math.cos(phase) * sine + math.sin(phase) * cosine)


EFFECT = Effect(
    id="cogging_torque",
    stage="load",
    sentence="The motor snaps from pole to pole; the torque ripples along the travel.",
    equation="load torque amplitude sin(periods_per_motor_revolution gear_ratio angle + phase)",
    source="Hanselman, Brushless Permanent Magnet Motor Design, 2nd ed. (2003)",
    elsewhere=Elsewhere(
        modelica={"load": "{amplitude}*sin({periods_per_motor_revolution}*gear_ratio*angle + {phase})"},
        quantities={
            "ripple_torque": "amplitude",
            "ripple_periods": "periods_per_motor_revolution",
            "ripple_phase": "phase",
        },
    ),
    shows_in="a ripple along the angle, at low velocity",
    record="very slow ramps over the whole travel",
    parameters=(
        Parameter(
            "amplitude",
            None,
            "amplitude at the shaft",
            "N.m",
            0.0,
            LARGEST,
            plausible=(0.0037, 0.0224),
            stride=5.0,
        ),
        Parameter(
            "periods_per_motor_revolution",
            None,
            "ripple periods in one turn of the motor, of the output under a torque drive",
            "1",
            0.0,
            1000.0,
            plausible=(1.0, float(PLAUSIBLE)),
            # a motor has a whole number of teeth
            searched=TURNS,
            geared=FINEST,
            rhythm=True,
        ),
        Parameter("phase", 0.0, "phase at angle 0", "rad", -6.3, 6.3, plausible=(-3.15, 3.15), measure="1"),
    ),
    strength=("amplitude",),
    along=along,
    typical={"amplitude": 0.0112086, "periods_per_motor_revolution": 6.0},
    variants=(Variant(("amplitude", "periods_per_motor_revolution", "phase"), _every_order),),
    ripple=Ripple("amplitude", "phase"),
    turns_within=_quarter_turn,
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
