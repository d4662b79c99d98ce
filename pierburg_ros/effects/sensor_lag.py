"""A slow position measurement."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """The measured samples behind a first-order lag that begins at rest on the first one.

    Exact for every drive and sensor: the lag acts after all that moves, on what was measured. Between two samples the
    signal is a straight line. Noise that should come after the lag is smoothed with it.
    """
    time, measured = channels.measured.time, channels.measured.values
    lagged = np.array(measured)
    for k, interval in enumerate(np.diff(time)):
        kept = math.exp(-interval / values["time_constant"])
        trail = (measured[k + 1] - measured[k]) / interval * values["time_constant"]
        lagged[k + 1] = measured[k + 1] - trail + kept * (lagged[k] - measured[k] + trail)
    return replace(channels, measured=Series(time, lagged))


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The torque between where the shaft is and where the sensor shows it."""
    behind = values["sensor_lag.time_constant"]
    return motion.displaced(values, behind * motion.velocity, behind * motion.acceleration)


EFFECT = Effect(
    id="sensor_lag",
    stage="sensor",
    sentence="The sensor shows where the shaft was a moment ago.",
    equation="time_constant d(measured angle)/dt = angle - measured angle",
    source="Doebelin, Measurement Systems, 5th ed. (2004)",
    elsewhere=Elsewhere(
        modelica={
            "variable": 'lagged(start = start_angle, fixed = true) "angle as the sensor follows it"',
            "equation": "der(lagged) = ({input} - lagged)/{time_constant}",
            "sensed": "lagged",
        }
    ),
    shows_in="fast travel and its sharp ends",
    record="sharp random steps, and contacts with a stop where there is one",
    parameters=(
        Parameter(
            "time_constant", None, "of the first-order lag", "s", 0.0, LARGEST, plausible=(0.021, 0.31), stride=5.0
        ),
    ),
    strength=("time_constant",),
    along=along,
    typical={"time_constant": 0.02094654},
    variants=(Variant(("time_constant",), grid(time_constant=(0.031, 0.105, 0.26))),),
    # rad, the angle that the sensor shows
    state=("lagged",),
    lag="time_constant",
    linear=True,
    put_in=put_in,
)


@kernel
def followed(p, lagged, start, end, duration):
    """Lagged angle [rad] after the angle has gone evenly from `start` to `end` [rad] in `duration` [s]."""
    if p.time_constant == 0.0 or duration == 0.0:
        return end if duration > 0.0 else lagged
    trail = (end - start) / duration * p.time_constant
    return end - trail + (lagged - start + trail) * math.exp(-duration / p.time_constant)
