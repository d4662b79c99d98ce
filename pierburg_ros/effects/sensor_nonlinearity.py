"""A Hall characteristic that bends."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.kernel import kernel

HALVINGS = 52
"""Halvings after which an interval of at most 0.6 spans is as small as rounding."""


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """The measured samples as a bent characteristic shows them.

    Exact for every drive, with a Hall sensor that was straight before: each sample depends on its own angle alone.
    """
    fraction = (channels.measured.values - channels.zero) / (channels.per_radian * channels.span)
    bend = values["amplitude"] * np.sin(values["half_waves"] * np.pi * fraction)
    shown = channels.measured.values + bend * channels.per_radian * channels.span
    return replace(channels, measured=Series(channels.measured.time, shown))


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The torque between where the shaft is and where the bent sensor shows it."""
    amplitude, waves = (values[f"sensor_nonlinearity.{name}"] for name in EFFECT.names)
    wavenumber = waves * np.pi / motion.span
    slope = amplitude * waves * np.pi * np.cos(wavenumber * motion.angle)
    shown = amplitude * motion.span * np.sin(wavenumber * motion.angle)
    return motion.displaced(values, -shown, -slope * motion.velocity)


EFFECT = Effect(
    id="sensor_nonlinearity",
    stage="sensor",
    sentence="The sensor reads a little too high or too low between its end points.",
    equation="Hall span (x + amplitude sin(half_waves pi x)), x = angle / (pi/2)",
    source="Fraden, Handbook of Modern Sensors, 5th ed. (2016)",
    elsewhere=Elsewhere(
        modelica={"sensed": "{input} + {amplitude}*sensor_span*sin({half_waves}*pi*({input})/sensor_span)"}
    ),
    shows_in="a smooth error over the angle, at rest too",
    record="standstills over the whole travel, and runs to both stops where there are such",
    parameters=(
        Parameter(
            "amplitude",
            None,
            "largest error as a fraction of the span",
            "1",
            -0.3,
            0.3,
            plausible=(-0.06, 0.06),
            stride=5.0,
        ),
        Parameter(
            "half_waves",
            None,
            "half waves over the span",
            "1",
            1.0,
            2.0,
            choices=(1.0, 2.0),
            plausible=(1.0, 2.0),
        ),
    ),
    strength=("amplitude",),
    along=along,
    typical={"amplitude": 0.0015, "half_waves": 1.0},
    variants=(
        Variant(("amplitude",), grid(amplitude=(-0.03, 0.03)), {"half_waves": 1.0}),
        Variant(("amplitude",), grid(amplitude=(-0.03, 0.03)), {"half_waves": 2.0}),
    ),
    linear=True,
    sensors=("hall_voltage",),
    put_in=put_in,
)


@kernel
def bent(p, fraction):
    """Indicated fraction of the span, at the true `fraction`."""
    if p.amplitude == 0.0:
        return fraction
    return fraction + p.amplitude * math.sin(p.half_waves * math.pi * fraction)


@kernel
def slope(p, fraction):
    """Derivative of `bent`: how much steeper the characteristic is than a straight one."""
    return 1.0 + p.amplitude * p.half_waves * math.pi * math.cos(p.half_waves * math.pi * fraction)


@kernel
def unbent(p, indicated):
    """True fraction of the span that shows as `indicated`, by bisection; one of them where several do."""
    low, high = indicated - abs(p.amplitude), indicated + abs(p.amplitude)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if bent(p, middle) < indicated:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
