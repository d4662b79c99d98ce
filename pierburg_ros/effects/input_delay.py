"""The duty takes effect late."""

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter, Variant, grid

EFFECT = Effect(
    id="input_delay",
    stage="input",
    sentence="The command arrives at the motor late.",
    equation="duty takes effect delay late",
    source="Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. (1998)",
    elsewhere=Elsewhere(modelica={"duty": "delay({input}, {delay})"}, quantities={"command_delay": "delay"}),
    shows_in="after each sharp change of duty",
    record="sharp random steps",
    parameters=(
        Parameter(
            "delay",
            None,
            "time between the command and its effect",
            "s",
            0.0,
            0.4,
            plausible=(0.002, 0.05),
            stride=2.0,
        ),
    ),
    strength=("delay",),
    typical={"delay": 0.002},
    variants=(Variant(("delay",), grid(delay=(0.003, 0.01, 0.02, 0.035, 0.06, 0.12))),),
    memory="brief",
    linear=True,
    jumps=True,
)
