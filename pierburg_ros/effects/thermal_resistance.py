"""The winding heats up and its resistance grows."""

import math
from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

SHORT_HEATING = 1e-3
"""Below this share of its time constant four terms of the power series are the exponential to rounding."""
COPPER = 0.0039
"""Temperature coefficient of the resistance of copper [1/K], from 20 degC (IEC 60028)."""


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The torque of the current that the warm winding lacks."""
    warmed = motion.over_time(lambda whole: 1.0 + COPPER * risen(whole, values))
    return motion.motor_torque(values) * (1.0 - 1.0 / warmed)


def risen(motion: Motion, values: Mapping[str, float]) -> Signal:
    """Temperature rise [K] along a whole motion, by the power that heats the winding at its own resistance then."""
    passing, capacity = (values[f"thermal_resistance.{name}"] for name in ("thermal_resistance", "heat_capacity"))
    cold = values["armature_resistance"]
    share = motion.step / (passing * capacity + motion.step)
    return np.asarray(warmed(np.square(motion.current(values)) * cold * passing, share))


EFFECT = Effect(
    id="thermal_resistance",
    stage="drive",
    sentence="The motor gets warm under load and weaker with it.",
    equation="R (1 + 0.0039 rise), heat_capacity d(rise)/dt = i^2 R - rise / thermal_resistance, "
    "rise 0 at the first sample",
    source="IEC, International standard of resistance for copper, IEC 60028 (1925)",
    elsewhere=Elsewhere(
        modelica={
            "variable": 'rise(start = 0, fixed = true, unit = "K") "of the winding\'s temperature"',
            "equation": "der(rise) = "
            f"(armature_resistance*(1 + {COPPER}*rise)*current^2 - rise/{{thermal_resistance}})/{{heat_capacity}}",
            "resistance": f"armature_resistance*{COPPER}*rise",
        },
        quantities={
            "winding_heat_resistance": "thermal_resistance",
            "winding_heat_capacity": "heat_capacity",
        },
    ),
    shows_in="the whole recording, the more the longer current is drawn",
    record="long holding at high duty, then a pause",
    parameters=(
        Parameter(
            "thermal_resistance",
            None,
            "winding to ambient; 0: no heating",
            "K/W",
            0.0,
            LARGEST,
            plausible=(0.86, 10.3),
            logarithmic=True,
        ),
        Parameter(
            "heat_capacity", None, "of the winding", "J/K", 0.0, LARGEST, plausible=(6.1, 305.0), logarithmic=True
        ),
    ),
    strength=("thermal_resistance",),
    along=along,
    typical={"thermal_resistance": 3.434525, "heat_capacity": 60.98818},
    variants=(
        Variant(
            ("thermal_resistance", "heat_capacity"),
            grid(thermal_resistance=(1.72, 5.15), heat_capacity=(9.15, 30.5, 122.0)),
        ),
    ),
    # K, of the winding
    state=("rise",),
    linear=True,
    drives=("voltage",),
)


@kernel
def warmed(final, share):
    """Temperature rise [K] that nears the `final` one of a cold winding by a `share` each sample, shape (samples,)."""
    rise = np.zeros(final.size)
    for place in range(1, final.size):
        rise[place] = rise[place - 1] + share * (final[place] / (1.0 + COPPER * rise[place - 1]) - rise[place - 1])
    return rise


@kernel
def resistance(p, cold_resistance, rise):
    """Armature resistance [ohm] at temperature `rise` [K]."""
    return cold_resistance * (1.0 + COPPER * rise)


@kernel
def heated(p, rise, power, falling, duration):
    """Temperature rise [K] after `duration` [s] at a `power` [W] that is `falling` by so much each kelvin [W/K]."""
    leaving = 1.0 / p.thermal_resistance + falling
    final = (power + falling * rise) / leaving
    if p.heat_capacity == 0.0:
        return final
    share = duration * leaving / p.heat_capacity
    if share < SHORT_HEATING:
        return rise + (final - rise) * share * (1.0 - 0.5 * share * (1.0 - share / 3.0 * (1.0 - 0.25 * share)))
    return final + (rise - final) * math.exp(-share)
