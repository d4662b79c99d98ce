"""The duty takes effect late."""

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter

EFFECT = Effect(
    id="input_delay",
    stage="input",
    sentence="The command arrives at the motor late.",
    equation="duty takes effect delay late",
    origin=CONTRACT,
    shows_in="after each sharp change of duty",
    record="sharp random steps",
    parameters=(Parameter("delay", "s", 0.0, 0.4, (0.002, 0.05), "time between the command and its effect"),),
    strength=("delay",),
)
