"""The resolution of the converter."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """The measured samples rounded to a coarser converter's steps.

    Exact for every drive and sensor where the recording's own steps are much finer: a sample within half of those of
    the edge between two coarse ones may fall on the wrong side.
    """
    step = values["step"]
    return replace(channels, measured=Series(channels.measured.time, step * np.rint(channels.measured.values / step)))


EFFECT = Effect(
    id="sensor_quantization",
    stage="sensor",
    sentence="The measurement comes in steps.",
    equation="measured value rounded to multiples of step",
    source="Widrow, Kollar, Quantization Noise (2008)",
    elsewhere=Elsewhere(modelica={"measured": "{step}*floor(({input})/{step} + 0.5)"}),
    shows_in="standstills; a staircase at slow travel",
    record="very slow ramps with little noise",
    parameters=(
        Parameter(
            "step",
            None,
            "resolution (rad where the angle itself is measured)",
            "V",
            0.0,
            LARGEST,
            plausible=(0.00024, 0.0122),
            measure="reading",
        ),
    ),
    strength=("step",),
    typical={"step": 0.001219512},
    linear=True,
    rounds="step",
    put_in=put_in,
)


@kernel
def rounded(p, value):
    """`value` on the converter's grid, same unit."""
    if p.step == 0.0:
        return value
    return math.floor(value / p.step + 0.5) * p.step
