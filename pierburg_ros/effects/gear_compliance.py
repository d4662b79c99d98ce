"""An elastic transmission between motor and shaft."""

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter

EFFECT = Effect(
    id="gear_compliance",
    stage="transmission",
    sentence="The gear twists under load before it passes the motion on.",
    equation="torque = stiffness (motor angle - angle) + damping (motor velocity - velocity)",
    origin=CONTRACT,
    shows_in="each reversal, and in proportion to the transmitted torque",
    record="reversals at several angles, and steps out of standstill",
    parameters=(
        Parameter(
            "stiffness",
            "N.m/rad",
            0.0,
            100000.0,
            (3.0, 60.0),
            "torsional stiffness at the shaft; 0: rigid",
        ),
        Parameter("damping", "N.m.s/rad", 0.0, 5.0, (0.001, 0.05), "damping of the twist", default=0.0),
    ),
    strength=("stiffness",),
)
