"""A slow position measurement."""

import math

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="sensor_lag",
    stage="sensor",
    sentence="The sensor shows where the shaft was a moment ago.",
    equation="time_constant d(measured angle)/dt = angle - measured angle",
    origin=CONTRACT,
    shows_in="fast travel and its sharp ends",
    record="sharp random steps and stop contacts",
    parameters=(Parameter("time_constant", "s", 0.0, 1.0, (0.002, 0.03), "of the first-order lag"),),
    strength=("time_constant",),
)


@kernel
def followed(p, lagged, start, end, duration):
    """Lagged angle [rad] after the angle has gone evenly from `start` to `end` [rad] in `duration` [s]."""
    if p.time_constant == 0.0 or duration == 0.0:
        return end if duration > 0.0 else lagged
    trail = (end - start) / duration * p.time_constant
    return end - trail + (lagged - start + trail) * math.exp(-duration / p.time_constant)
