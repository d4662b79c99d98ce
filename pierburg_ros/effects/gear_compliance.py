"""An elastic transmission between motor and shaft."""

from pierburg_ros.effects.effect import MOTORS, Effect, Parameter, Variant, grid

EFFECT = Effect(
    id="gear_compliance",
    stage="transmission",
    sentence="The gear twists under load before it passes the motion on.",
    equation="torque = stiffness (motor angle - angle) + damping (motor velocity - velocity)",
    source="Spong, Modeling and control of elastic joint robots (1987)",
    shows_in="each reversal, and in proportion to the transmitted torque",
    record="reversals at several angles, and steps out of standstill",
    parameters=(
        Parameter(
            "stiffness",
            None,
            "torsional stiffness at the shaft; 0: rigid",
            "N.m/rad",
            0.0,
            100000.0,
            plausible=(3.0, 60.0),
            logarithmic=True,
        ),
        Parameter(
            "damping",
            0.0,
            "damping of the twist",
            "N.m.s/rad",
            0.0,
            5.0,
            plausible=(0.001, 0.05),
            logarithmic=True,
        ),
    ),
    strength=("stiffness",),
    typical={"stiffness": 30.0, "damping": 0.01},
    variants=(Variant(("stiffness", "damping"), grid(stiffness=(4.0, 12.0, 40.0), damping=(0.01,))),),
    memory="brief",
    linear=True,
    drives=MOTORS,
)
