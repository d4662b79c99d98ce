"""A load torque from outside: constant, pulsating, or for a while."""

import math

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="external_load",
    stage="load",
    sentence="Something pushes on the valve from outside, steadily or in pulses.",
    equation="load torque torque + amplitude sin(2 pi frequency t + phase) for start <= t < end",
    origin=CONTRACT,
    shows_in="a span of time, or a rhythm in time",
    record="standstills long enough to see several pulses",
    parameters=(
        Parameter("torque", "N.m", -5.0, 5.0, (-0.1, 0.1), "constant part, positive closes", default=0.0),
        Parameter(
            "amplitude",
            "N.m",
            0.0,
            5.0,
            (0.01, 0.1),
            "amplitude of the pulsating part",
            default=0.0,
        ),
        Parameter(
            "frequency",
            "Hz",
            0.0,
            200.0,
            (0.2, 20.0),
            "frequency of the pulsating part",
            default=0.0,
        ),
        Parameter("phase", "rad", -6.3, 6.3, (-3.15, 3.15), "phase at the first sample", default=0.0),
        Parameter(
            "start",
            "s",
            0.0,
            1000000000.0,
            (0.0, 60.0),
            "first moment of the load, from the first sample",
            default=0.0,
        ),
        Parameter(
            "end",
            "s",
            0.0,
            1000000000.0,
            (0.0, 60.0),
            "end of the load, from the first sample; 0: never",
            default=0.0,
        ),
    ),
    strength=("torque", "amplitude"),
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
def next_switch(p, time):
    """The next moment [s] after `time` at which the load starts or ends; infinite where there is none."""
    if time < p.start:
        return p.start
    if time < p.end:
        return p.end
    return math.inf
