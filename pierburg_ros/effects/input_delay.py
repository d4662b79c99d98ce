"""The duty takes effect late."""

from collections.abc import Mapping
from dataclasses import replace

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.intake.bounds import LARGEST


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """The command logged earlier than it was: what acted at a time was commanded the delay before.

    Exact for every drive and sensor. Earlier is the causal way: of a command logged later the effect would come first.
    Supply voltage and bridge act when they act, and keep their times.
    """
    return replace(channels, command=Series(channels.command.time - values["delay"], channels.command.values))


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What the command would have driven at once, less what the late one drives."""
    return motion.driven(values, motion.command - motion.commanded(values["input_delay.delay"]))


EFFECT = Effect(
    id="input_delay",
    stage="input",
    sentence="The command arrives at the motor late.",
    equation="duty takes effect delay late",
    source="Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd ed. (1998)",
    elsewhere=Elsewhere(modelica={"command": "delay({input}, {delay})"}, quantities={"command_delay": "delay"}),
    shows_in="after each sharp change of duty",
    record="sharp random steps",
    parameters=(
        Parameter(
            "delay",
            None,
            "time between the command and its effect",
            "s",
            0.0,
            LARGEST,
            plausible=(0.021, 0.52),
            searched=(0.0, 4.2),
            stride=2.0,
        ),
    ),
    strength=("delay",),
    along=along,
    typical={"delay": 0.02094654},
    variants=(Variant(("delay",), grid(delay=(0.031, 0.105, 0.21, 0.37, 0.63, 1.26))),),
    linear=True,
    put_in=put_in,
    dead_time="delay",
)
