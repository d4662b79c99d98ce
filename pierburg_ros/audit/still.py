"""Signals that keep one value: a sensor that is not read, a shaft that does not move."""

from __future__ import annotations

import numpy as np

from pierburg_ros.audit.explained import simulated_from
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model
from pierburg_ros.recording.noise import noise_of

FAR = 0.1
"""Share of the actuator's own scale by which the inputs would move it at least. Chosen: no friction holds it against
inputs that move it so far."""
MOVED = 30.0
"""Span of the readings, in noises, below which nothing shows that the shaft moves. Derived: 10,000 samples of white
noise span 8; slow drift of a sensor is left room."""


def still(signals: Signals, nominal: Model) -> list[Fault] | None:
    """What is wrong with signals in which nothing moves; None where something does.

    A shaft may be stuck, and a weak input may leave it where it is. But where every reading is the same to the last
    digit while such inputs would move the actuator far, the sensor is not read.
    """
    span = float(np.ptp(signals.measured))
    if span > MOVED * noise_of(signals.time, signals.measured):
        return None
    if span > 0.0:
        return []
    would = simulated_from(signals, nominal)
    far = nominal.scales.reading if signals.quantity == "speed" else nominal.scales.angle
    if not np.ptp(would) > FAR * far:
        return []
    low, high = float(np.min(signals.command)), float(np.max(signals.command))
    return [
        Fault(
            signals.name,
            signals.quantity,
            "constant",
            f"It reads {signals.measured[0]:.4g} throughout, while the {signals.input} runs from {low:.3g} to"
            f" {high:.3g}.",
            f"name the topic of the sensor: `{signals.quantity}: {{topic: ...}}`",
        )
    ]
