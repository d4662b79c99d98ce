"""A recording as topics of an MCAP file that can be read, replayed and diagnosed again."""

from __future__ import annotations

from pierburg_ros.recording import Recording
from pierburg_ros.recording.write import Signal

FLOAT64 = "std_msgs/msg/Float64"
MEASURED = {
    "hall_voltage": ("/hall_voltage", FLOAT64),
    "position": ("/joint_states", "sensor_msgs/msg/JointState"),
}
"""Topic and message type of each measured quantity."""


def topics_of(recording: Recording) -> dict[str, Signal]:
    """Message type, times [s] and values by topic; at equal times a setpoint comes first and a duty last."""
    topic, kind = MEASURED[recording.quantity]
    channels = {
        "/setpoints": (FLOAT64, recording.setpoints),
        "/supply_voltage": (FLOAT64, recording.supply_voltage),
        "/temperature": (FLOAT64, recording.temperature),
        "/enabled": ("std_msgs/msg/Bool", recording.enabled),
        "/duty": (FLOAT64, recording.duty),
    }
    signals: dict[str, Signal] = {
        name: (type_name, channel.time, channel.values)
        for name, (type_name, channel) in channels.items()
        if channel is not None
    }
    duty = signals.pop("/duty")
    return {**signals, topic: (kind, recording.time, recording.measured), "/duty": duty}
