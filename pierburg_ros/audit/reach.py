"""What signals can be at all: readings between the stops, sample times that show the motion."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded

BEYOND = 0.06
"""Share of the travel by which a reading may lie beyond a stop. Chosen: a sensor's zero may be off by 3 %, its curve
and a soft stop add as much."""
DOUBTFUL = 0.03
"""Share of the travel beyond a stop from which a slip of the sensor is looked for, though the motion is explained.
Chosen: half of what is impossible."""
STRAYS = 0.05
"""Share of the samples that may lie farther out. Chosen: spikes of a sensor are rarer."""
CLOSEST, FARTHEST = 1e-5, 10.0
"""Sample intervals in the time in which the actuator crosses its travel at full speed, the least and the largest.
Chosen: a hundred thousand samples to a movement are no recording of it, a tenth of a sample neither."""


def impossible(signals: Signals, nominal: Model, beyond: float = BEYOND) -> tuple[str, str] | None:
    """Which signal cannot be what it is read as, and how that shows; None where every one can.

    `beyond` is the share of the travel by which a reading may lie beyond a stop.
    """
    fastest = nominal.scales.time
    if not CLOSEST <= signals.interval / fastest <= FARTHEST or signals.duration < fastest:
        return "time", (
            f"Samples lie {signals.interval:.3g} s apart over {signals.duration:.3g} s, where the actuator crosses its"
            f" travel in {fastest:.2g} s."
        )
    actuator, supply = nominal.actuator, signals.inputs.supply_voltage
    most = actuator.parameters["supply_voltage"].maximum if actuator.drive == "voltage" else math.inf
    if supply is not None and np.median(supply) > most:
        return "supply_voltage", f"It is {np.median(supply):.4g} V, and the actuator's at most {most:g} V."
    travel = actuator.upper_stop - actuator.lower_stop
    if signals.quantity == "speed" or not math.isfinite(travel):
        return None
    angle = decoded(nominal, signals.measured, signals.quantity)
    low, high = actuator.lower_stop - beyond * travel, actuator.upper_stop + beyond * travel
    outside = float(np.mean((angle < low) | (angle > high)))
    if outside > STRAYS:
        lowest, highest = np.percentile(signals.measured, [1.0, 99.0])
        return signals.quantity, (
            f"It reads {lowest:.4g} to {highest:.4g} and is beyond the stops for {100 * outside:.0f} % of the time."
        )
    return None
