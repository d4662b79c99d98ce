"""The simulator knows no units: in others it makes the same signals.

Factors that are powers of two only change the exponents of floating-point numbers, so that the signals have to be the
same bit for bit: any number with a unit that is left in a kernel shows. Decimal factors round otherwise at each step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.gauge import Gauge

HALL = read_actuator("pierburg")
POSITION = replace(HALL, quantity="position")
TIME, DUTY = rich_duty(6.0)
BINARY = [Gauge(torque=2.0**7), Gauge(torque=2.0**-7, time=2.0**-4), Gauge(time=2.0**3, angle=2.0**5)]
DECIMAL = [Gauge(torque=100.0, time=0.1), Gauge(torque=0.01, time=10.0, angle=20.0)]


def signal(actuator: Actuator, effect: str | None, gauge: Gauge) -> np.ndarray:
    """What an actuator with one effect measures under a rich duty, brought back from the units of `gauge`."""
    model = Model.nominal(actuator)
    if effect is not None:
        model = model.with_values(EFFECT[effect].typical_values(model.values, model.scales))
    changed = Model.nominal(gauge.actuator(actuator)).with_values(gauge.values(model.values, actuator))
    made = simulate(changed, Inputs(TIME * gauge.time, DUTY), TIME * gauge.time)
    return made / gauge.measured(actuator.quantity)


def acting(gauge: Gauge) -> list[tuple[Actuator, str | None]]:
    """The valve, or where angles are changed the valve that measures its angle, with each effect that can act."""
    actuator = HALL if gauge.angle == 1.0 else POSITION
    return [(actuator, None), *((actuator, e.id) for e in EFFECTS if actuator.quantity in e.sensors)]


def cases(gauges: list[Gauge]) -> list[object]:
    return [
        pytest.param(actuator, effect, gauge, id=f"{effect}-{gauge.torque:g}-{gauge.time:g}-{gauge.angle:g}")
        for gauge in gauges
        for actuator, effect in acting(gauge)
    ]


@pytest.mark.parametrize(("actuator", "effect", "gauge"), cases(BINARY))
def test_signals_are_the_same_bit_for_bit(actuator: Actuator, effect: str | None, gauge: Gauge) -> None:
    assert np.array_equal(signal(actuator, effect, gauge), signal(actuator, effect, Gauge()))


@pytest.mark.parametrize(("actuator", "effect", "gauge"), cases(DECIMAL))
def test_signals_are_the_same_to_rounding(actuator: Actuator, effect: str | None, gauge: Gauge) -> None:
    """An event moved by rounding is found a moment later; the tolerance is what the internal steps may be wrong by."""
    left = signal(actuator, effect, gauge) - signal(actuator, effect, Gauge())
    step = EFFECT["sensor_quantization"].typical["step"] * 4.2 if effect == "sensor_quantization" else 0.0
    assert np.sqrt(np.mean(left**2)) < 1e-6 + 0.1 * step
