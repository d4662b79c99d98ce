"""A bridge that ignores small duty."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.effects.put_in import CannotPutIn, Channels, Series
from pierburg_ros.kernel import kernel


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """The duty that, less the dead band, is the one recorded: further from 0 by the width, and 0 where it was 0.

    Exact for a voltage drive and every sensor: the motor gets the voltage that it got. A duty cannot exceed 1. Where it
    would, the supply voltage is told higher and the duty smaller by the same factor, which leaves the voltage at the
    motor; CannotPutIn where no supply voltage was recorded.
    """
    width, duty, supply = values["width"], channels.command.values, channels.supply_voltage
    factor = min((1.0 - width) / max(float(np.max(np.abs(duty))), 1.0 - width), 1.0)
    if factor < 1.0 and supply is None:
        raise CannotPutIn("the duty reaches 1, and no supply voltage was recorded")
    raised = np.where(duty == 0.0, 0.0, factor * duty + np.copysign(width, duty))
    return replace(
        channels,
        command=Series(channels.command.time, raised),
        supply_voltage=None if supply is None else Series(supply.time, supply.values / factor),
    )


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What the lost duty would have driven."""
    width = values["pwm_deadband.width"]
    return motion.driven(values, motion.of_command(lambda duty: np.clip(duty, -width, width)))


EFFECT = Effect(
    id="pwm_deadband",
    stage="input",
    sentence="Small commands do not reach the motor.",
    equation="effective duty = sign(duty) max(abs(duty) - width, 0)",
    source="Mohan, Undeland, Robbins, Power Electronics, 3rd ed. (2003)",
    elsewhere=Elsewhere(modelica={"command": "sign({input})*max(abs({input}) - {width}, 0)"}),
    shows_in="small duty, and every change of its sign",
    record="the return at duty 0, and negative duty",
    parameters=(
        Parameter(
            "width", None, "duty that is lost", "1", 0.0, 1.0, plausible=(0.004, 0.04), searched=(0.0, 0.5), stride=5.0
        ),
    ),
    strength=("width",),
    along=along,
    typical={"width": 0.02},
    variants=(Variant(("width",), grid(width=(0.005, 0.015, 0.04))),),
    linear=True,
    drives=("voltage",),
    put_in=put_in,
)


@kernel
def effective(p, duty):
    """Duty that reaches the motor."""
    if p.width == 0.0:
        return duty
    return math.copysign(max(abs(duty) - p.width, 0.0), duty)
