"""A load torque from outside: constant, pulsating, or for a while."""

import itertools
import math
from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import (
    QUADRATURE,
    Effect,
    Elsewhere,
    Motion,
    Parameter,
    Reach,
    Ripple,
    Start,
    Variant,
)
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

FREQUENCIES = (0.0095, 1.9)
"""Range in which the rhythm of a load is looked for, in periods to the time of a travel: slower ones take longer than a
recording, and the shaft hardly follows faster ones."""


def _every_rhythm(reach: Reach) -> Sequence[Start]:
    """Rhythms so close that one lies within half a period over the recording of any other, at two phases each."""
    slowest, fastest = FREQUENCIES
    rhythms = np.arange(max(slowest, 1.0 / reach.duration), fastest, 0.5 / reach.duration)
    return [
        {"amplitude": 0.0075, "frequency": float(rhythm), "phase": phase} for rhythm in rhythms for phase in QUADRATURE
    ]


def _every_span(reach: Reach) -> Sequence[Start]:
    """Spans between thirty evenly spaced moments, the last of them to the end of the recording."""
    moments = np.linspace(0.0, reach.duration, 31)
    spans = itertools.combinations(moments, 2)
    return [
        {"torque": 0.0075, "start": float(start), "end": float(end) if end < reach.duration else 0.0}
        for start, end in spans
        if end - start < 0.97 * reach.duration
    ]


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The load at each moment."""
    steady, amplitude, frequency, phase, start, end = (values[f"external_load.{name}"] for name in EFFECT.names)
    acts = (motion.time >= start) & (motion.time < (end or math.inf))
    return np.asarray(acts * (steady + amplitude * np.sin(2.0 * math.pi * frequency * motion.time + phase)))


EFFECT = Effect(
    id="external_load",
    stage="load",
    sentence="Something pushes on the shaft from outside, steadily or in pulses.",
    equation="load torque torque + amplitude sin(2 pi frequency t + phase) for start <= t < end",
    source="Wittenburg, Dynamics of Multibody Systems, 2nd ed. (2008)",
    elsewhere=Elsewhere(
        modelica={
            "load": "(if time >= {start} and ({end} <= 0 or time < {end}) "
            "then {torque} + {amplitude}*sin(2*pi*{frequency}*time + {phase}) else 0)"
        }
    ),
    shows_in="a span of time, or a rhythm in time",
    record="standstills long enough to see several pulses",
    parameters=(
        Parameter(
            "torque",
            0.0,
            "constant part, positive closes",
            "N.m",
            -LARGEST,
            LARGEST,
            plausible=(-0.0374, 0.0374),
            stride=5.0,
        ),
        Parameter(
            "amplitude",
            0.0,
            "amplitude of the pulsating part",
            "N.m",
            0.0,
            LARGEST,
            plausible=(0.0037, 0.0374),
            stride=5.0,
        ),
        Parameter(
            "frequency",
            0.0,
            "frequency of the pulsating part",
            "Hz",
            0.0,
            LARGEST,
            plausible=(0.019, 1.9),
            # a slower rhythm is a constant torque
            searched=(0.0019, 19.0),
            rhythm=True,
        ),
        Parameter(
            "phase",
            0.0,
            "phase at the first sample",
            "rad",
            -6.3,
            6.3,
            plausible=(-3.15, 3.15),
            measure="1",
            dated=True,
        ),
        Parameter(
            "start",
            0.0,
            "first moment of the load, from the first sample",
            "s",
            0.0,
            LARGEST,
            plausible=(0.0, 630.0),
            dated=True,
        ),
        Parameter(
            "end",
            0.0,
            "end of the load, from the first sample; 0: never",
            "s",
            0.0,
            LARGEST,
            plausible=(0.0, 630.0),
            dated=True,
        ),
    ),
    strength=("torque", "amplitude"),
    along=along,
    typical={"torque": 0.018681, "amplitude": 0.0112086, "frequency": 0.1909623},
    variants=(
        Variant(("amplitude", "frequency", "phase"), _every_rhythm),
        Variant(("torque", "start", "end"), _every_span),
    ),
    ripple=Ripple("amplitude", "phase"),
)


@kernel
def acts(p, time):
    """Whether the load acts at `time` [s]."""
    return time >= p.start and (p.end == 0.0 or time < p.end)


@kernel
def torque(p, time):
    """Load torque [N.m] at `time` [s] from the first sample."""
    if not acts(p, time):
        return 0.0
    return p.torque + p.amplitude * math.sin(2.0 * math.pi * p.frequency * time + p.phase)


@kernel
def rate(p, time):
    """Derivative of `torque` with respect to time [N.m/s]."""
    if not acts(p, time):
        return 0.0
    pulsation = 2.0 * math.pi * p.frequency
    return p.amplitude * pulsation * math.cos(pulsation * time + p.phase)


@kernel
def taking(p, spare):
    """Time [s] that the load takes at least to change by `spare` [N.m], but for its start and end."""
    fastest = 2.0 * math.pi * p.frequency * p.amplitude
    return spare / fastest if fastest > 0.0 else math.inf


@kernel
def next_switch(p, time):
    """The next moment [s] after `time` at which the load starts or ends; infinite where there is none."""
    if time < p.start:
        return p.start
    if time < p.end:
        return p.end
    return math.inf
