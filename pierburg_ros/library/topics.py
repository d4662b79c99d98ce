"""A recording as topics of an MCAP file that can be read, replayed and diagnosed again."""

from __future__ import annotations

from pierburg_ros.recording import Recording
from pierburg_ros.recording.write import MEASURED, Signal

FLOAT64 = "std_msgs/msg/Float64"


def topics_of(recording: Recording) -> dict[str, Signal]:
    """Message type, times [s] and values by topic; at equal times a setpoint comes first and the command last."""
    topic, kind = MEASURED[recording.quantity]
    driving = f"/{recording.input}"
    channels = {
        "/setpoints": (FLOAT64, recording.setpoints),
        "/supply_voltage": (FLOAT64, recording.supply_voltage),
        "/temperature": (FLOAT64, recording.temperature),
        "/enabled": ("std_msgs/msg/Bool", recording.enabled),
        driving: (FLOAT64, recording.command),
    }
    signals: dict[str, Signal] = {
        name: (type_name, channel.time, channel.values)
        for name, (type_name, channel) in channels.items()
        if channel is not None
    }
    command = signals.pop(driving)
    return {**signals, topic: (kind, recording.time, recording.measured), driving: command}
