"""Plain PI and PID to compare with: the same controller, a weighted sum in place of the fuzzy stage.

Filter, dead zone, anti-windup, limits and transitions are those of the PIFLC, so that a comparison shows the
fuzzy stage alone. duty = PI output / pi_output_support + derivative / derivative_support; the output sets are
not used. A derivative_support of 1e9 V/s, its maximum, makes it a PI.
"""

from __future__ import annotations

from typing import Any

from pierburg_ros.control.law import follow, give, scheduled
from pierburg_ros.kernel import kernel


@kernel
def step(settings: Any, state: Any, setpoint: float, hall_voltage: float, dt: float) -> float:
    """Duty [1] for one sample: setpoint [rad], Hall voltage [V], time since the previous sample [s]."""
    follow(settings, state, setpoint, hall_voltage, dt)
    proportional = state.pi_output / settings.pi_output_support
    weighed = proportional + state.derivative / settings.derivative_support
    return give(settings, state, scheduled(settings, state) + weighed, dt)
