"""Static friction above the sliding friction, with a Stribeck curve between them."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Motion, Parameter, Start, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What slow sliding meets beyond Coulomb friction; the larger part shows at rests."""
    excess = values["static_friction.breakaway_torque"] - values["coulomb_friction"]
    share = motion.velocity / max(values["static_friction.stribeck_velocity"], 1e-300)
    return motion.direction * excess * np.exp(-np.square(share))


BORNE = 0.9
"""Share of the rests that bear less than what breaks the shaft loose. Chosen: a tenth may be an error of the load; most
rests end before they bear all."""


def at_rests(rests: Sequence[Motion], values: Mapping[str, float]) -> tuple[Start, float]:
    """A rest bears up to the breakaway torque, and bears most of it just before the shaft moves."""
    beyond = [float(np.max(np.abs(rest.held(values)))) - values["coulomb_friction"] for rest in rests] or [0.0]
    excess = float(np.quantile(beyond, BORNE))
    before, after = (float(np.sum(np.square(np.maximum(each, 0.0)))) for each in (beyond, np.subtract(beyond, excess)))
    return {"breakaway_torque": excess}, 1.0 - after / before if before > 0.0 else 0.0


EFFECT = Effect(
    id="static_friction",
    stage="friction",
    sentence="It sticks harder than it slides: after standing still the shaft breaks loose with a jump.",
    equation="friction level T_c + (breakaway_torque - T_c) exp(-(w/stribeck_velocity)^2), "
    "stick up to breakaway_torque",
    source=ARMSTRONG,
    elsewhere=Elsewhere(
        modelica={
            "friction_level": "({breakaway_torque} - coulomb_friction)"
            "*exp(-(velocity/max({stribeck_velocity}, 1e-6))^2)"
        },
        quantities={"breakaway_friction": "breakaway_torque", "stribeck_speed": "stribeck_velocity"},
    ),
    shows_in="first movement after standstill",
    record="slow ramps with standstills between them",
    parameters=(
        Parameter(
            "breakaway_torque",
            None,
            "torque that breaks the shaft loose; at least coulomb_friction",
            "N.m",
            0.0,
            LARGEST,
            plausible=(0.079, 0.12),
            above="coulomb_friction",
        ),
        Parameter(
            "stribeck_velocity",
            0.0,
            "velocity over which the excess fades; 0: at once",
            "rad/s",
            0.0,
            LARGEST,
            plausible=(0.0012, 0.018),
            logarithmic=True,
        ),
    ),
    strength=("breakaway_torque",),
    # what exceeds the sliding friction, here 40 % of the Pierburg actuator's
    along=along,
    mark="rests",
    at_rests=at_rests,
    typical={"breakaway_torque": 0.02999422, "stribeck_velocity": 0.006078519},
    variants=(
        Variant(
            ("breakaway_torque", "stribeck_velocity"),
            grid(breakaway_torque=(0.0112, 0.0224, 0.0374), stribeck_velocity=(0.0024, 0.0073)),
        ),
    ),
)


@kernel
def excess(p, coulomb_friction, velocity):
    """Friction above the sliding level [N.m], at `velocity` [rad/s]."""
    if p.breakaway_torque <= coulomb_friction:
        return 0.0
    if p.stribeck_velocity == 0.0:
        return p.breakaway_torque - coulomb_friction if velocity == 0.0 else 0.0
    ratio = velocity / p.stribeck_velocity
    return (p.breakaway_torque - coulomb_friction) * math.exp(-ratio * ratio)


@kernel
def slope(p, velocity, excess):
    """Derivative of `excess` [N.m] with respect to velocity [N.m.s/rad]."""
    if excess == 0.0 or p.stribeck_velocity == 0.0:
        return 0.0
    return -2.0 * velocity / (p.stribeck_velocity * p.stribeck_velocity) * excess
