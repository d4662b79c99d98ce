"""Free play between motor and shaft."""

from pierburg_ros.effects.effect import MOTORS, Effect, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST

EFFECT = Effect(
    id="backlash",
    stage="transmission",
    sentence="The gear teeth have play: after the motor has backed away it turns a little before the shaft follows.",
    equation="total free play gap between motor and shaft, opening flank touching at the start, "
    "friction split between the two sides by motor_friction_share, inertia on the motor side",
    source="Nordin, Gutman, Controlling mechanical systems with backlash - a survey (2002)",
    shows_in="leaving the closed stop after negative duty",
    record="a push that turns round at rest, as duty below 0 at a closed stop and then open, several times",
    parameters=(
        Parameter(
            "gap",
            None,
            "total free play at the shaft",
            "rad",
            0.0,
            LARGEST,
            plausible=(0.0064, 0.076),
            searched=(0.0, 0.32),
            stride=2.0,
        ),
        Parameter(
            "motor_friction_share",
            0.0,
            "share of the friction on the motor side",
            "1",
            0.0,
            1.0,
            plausible=(0.05, 0.5),
        ),
    ),
    strength=("gap",),
    mark="reversals",
    typical={"gap": 0.009549297, "motor_friction_share": 0.2},
    variants=(
        Variant(("gap", "motor_friction_share"), grid(gap=(0.0095, 0.0255, 0.051), motor_friction_share=(0.1, 0.4))),
    ),
    linear=True,
    drives=MOTORS,
    play="gap",
)
