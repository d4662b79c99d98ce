"""Free play between motor and shaft."""

from pierburg_ros.effects.effect import Effect, Parameter

EFFECT = Effect(
    id="backlash",
    stage="transmission",
    sentence="The gear teeth have play: after the motor has backed away it turns a little before the shaft follows.",
    equation="total free play gap between motor and shaft, opening flank touching at the start, "
    "friction split between the two sides by motor_friction_share, inertia on the motor side",
    origin="Nordin, Gutman, Automatica 38 (2002) 1633-1649",
    shows_in="leaving the closed stop after negative duty",
    record="duty below 0 at the closed stop, then open, several times",
    parameters=(
        Parameter("gap", "rad", 0.0, 0.5, (0.01, 0.12), "total free play at the shaft"),
        Parameter(
            "motor_friction_share",
            "1",
            0.0,
            1.0,
            (0.05, 0.5),
            "share of the friction on the motor side",
            default=0.0,
        ),
    ),
    strength=("gap",),
)
