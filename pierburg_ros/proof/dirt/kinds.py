"""All kinds of dirt, by name."""

from __future__ import annotations

from collections.abc import Callable

from pierburg_ros.arrays import Signal
from pierburg_ros.proof.dirt import disturbance, messages, sensor
from pierburg_ros.proof.dirt.disturbance import Disturbance
from pierburg_ros.proof.dirt.log import Log, Random

SPOILING: dict[str, Callable[[Log, Random], Log]] = {
    "spikes": sensor.spikes,
    "hum": sensor.hum,
    "sensor_drift": sensor.drifting,
    "clipping": sensor.clipping,
    "lost_messages": messages.lost_messages,
    "lost_rows": messages.lost_rows,
    "jitter": messages.jitter,
    "begins_in_motion": messages.begins_in_motion,
    "coarse_duty": messages.coarse_duty,
    "late_duty": messages.late_duty,
    "fast_clock": messages.fast_clock,
}
"""What makes another log of the same run."""
DISTURBING: dict[str, Callable[[Signal, Random], Disturbance]] = {
    "supply": disturbance.supply,
    "hand": disturbance.hand,
    "open_bridge": disturbance.open_bridge,
}
"""What makes another run of the same duty."""
DIRT = (*SPOILING, *DISTURBING)
