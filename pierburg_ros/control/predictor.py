"""A Smith predictor ahead of the control law: what the sensor will show once the duties given so far have acted.

A loop whose command arrives late, or whose sensor lags, is corrected again for what is already under way, and swings.
The predictor adds to the measured voltage what a simple model of the shaft has moved that the sensor cannot show yet,
so that the law sees a loop without delay (O. J. M. Smith, Closer control of loops with dead time, Chemical Engineering
Progress 53 (1957) 217-219). A model that slides where the shaft rests, as after the winding has become hot, would leave
an offset. So what the sensor does beside the model is followed as a drift of the model, in the spirit of M. R. Matausek
and A. D. Micic (A modified Smith predictor for controlling a process with an integrator and long dead-time, IEEE
Transactions on Automatic Control 41 (1996) 1199-1203).

The model is the sliding shaft of the nominal plant, in Hall voltage U and duty D:

    dU/dt = speed (D - load(U) - friction sign),   0 within the friction band, between the stops

With no delay and no lag, which is the default, the measurement passes as it is, bit for bit.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pierburg_ros.kernel import kernel

LARGEST_VOLTAGE = 1e6
"""Voltages [V] beyond this count as this, as in the control law."""
DRIFTING = 0.1
"""Time constant [s] with which a drift of the model is followed. Chosen: three times the longest delay of the practice
recordings, so that a step is over before; noise of 3 mV then moves the prediction by less than 1 mV."""
LONGEST_DELAY = 128
"""Samples that a predicted delay may have at most; a longer one counts as this. Chosen: 0.25 s at 500 Hz."""
STATE = [
    ("newest", np.int64),  # place of the last movement in the ring
    ("movements", np.float64, (LONGEST_DELAY + 1,)),  # modelled between two samples, the last ones [V]
    ("behind", np.float64),  # by how much a lagging sensor is behind the delayed shaft [V]
    ("shown", np.float64),  # last measured [V]
    ("drift", np.float64),  # what the sensor does beside the model [V/s]
    ("ahead", np.float64),  # by how much the shaft will be ahead of the sensor, all together [V]
]


@kernel
def forget(state: Any) -> None:
    """Nothing has moved yet."""
    state.newest = 0
    state.movements[:] = 0.0
    state.behind = state.shown = state.drift = state.ahead = 0.0


@kernel
def predicted(settings: Any, state: Any, hall_voltage: float, duty: float, dt: float) -> float:
    """Hall voltage [V] that the sensor will come to show, from the one it shows [V] and the last duty given [1]."""
    if settings.predictor_delay == 0.0 and settings.predictor_lag == 0.0:
        return hall_voltage
    hall_voltage = min(max(hall_voltage, -LARGEST_VOLTAGE), LARGEST_VOLTAGE)
    move(settings, state, hall_voltage + state.ahead, duty, dt)
    samples = int(min(settings.predictor_delay / dt + 0.5, LONGEST_DELAY))
    under_way = 0.0
    for age in range(samples):
        under_way += state.movements[state.newest - age]
    arrived = state.movements[state.newest - samples]
    behind = trailing(state.behind, arrived, settings.predictor_lag, dt)
    if state.shown != 0.0:
        beside = (hall_voltage - state.shown - arrived + behind - state.behind) / dt
        state.drift += (beside - state.drift) * dt / (dt + DRIFTING)
    state.behind, state.shown = behind, hall_voltage
    drifted = state.drift * (settings.predictor_delay + settings.predictor_lag)
    low = min(settings.hall_voltage_closed - hall_voltage, 0.0)
    high = max(settings.hall_voltage_open - hall_voltage, 0.0)
    state.ahead = min(max(under_way + behind + drifted, low), high)
    ahead: float = hall_voltage + state.ahead
    return ahead


@kernel
def trailing(behind: float, moved: float, lag: float, dt: float) -> float:
    """By how much [V] a first-order lag [s] trails what has `moved` evenly [V] within `dt` [s], `behind` [V] before."""
    if lag == 0.0:
        return 0.0
    kept = math.exp(-dt / lag)
    trail: float = behind * kept + moved * (1.0 - kept) * lag / dt
    return trail


@kernel
def move(settings: Any, state: Any, voltage: float, duty: float, dt: float) -> None:
    """Note how far the modelled shaft at a voltage [V] goes in a time [s] under a duty [1]."""
    span = settings.hall_voltage_open - settings.hall_voltage_closed
    share = (voltage - settings.hall_voltage_closed) / span
    surplus = duty - settings.load_closed - share * (settings.load_open - settings.load_closed)
    sliding = max(abs(surplus) - settings.predictor_friction, 0.0)
    way = settings.predictor_speed * sliding * dt if surplus > 0.0 else -settings.predictor_speed * sliding * dt
    low = min(settings.hall_voltage_closed - voltage, 0.0)
    high = max(settings.hall_voltage_open - voltage, 0.0)
    state.newest = (state.newest + 1) % (LONGEST_DELAY + 1)
    state.movements[state.newest] = min(max(way, low), high)
