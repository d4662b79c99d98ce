"""The signals of a recording: one name each in bags, CSV and signal maps, its unit, and where it is found unnamed.

Section 3 of docs/contract.md names them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from pierburg_ros.recording.formats.cdr import BOOL, FLOAT64, JOINT_STATE


@dataclass(frozen=True)
class SignalName:
    """One signal: its units in SI (the second that of a linear actuator), its topics by last name, its column."""

    units: tuple[str, ...]
    topics: dict[str, str]
    column: str


SIGNALS = {
    "duty": SignalName(("1",), {"duty": FLOAT64}, "duty"),
    "applied_duty": SignalName(("1",), {"applied_duty": FLOAT64}, "applied_duty"),
    "current": SignalName(("A",), {"current": FLOAT64}, "current"),
    "torque": SignalName(("N.m", "N"), {"torque": FLOAT64}, "torque"),
    "hall_voltage": SignalName(("V",), {"hall_voltage": FLOAT64}, "hall_voltage"),
    "position": SignalName(("rad", "m"), {"joint_states": JOINT_STATE, "position": FLOAT64}, "position"),
    "speed": SignalName(("rad/s", "m/s"), {"speed": FLOAT64}, "speed"),
    "supply_voltage": SignalName(("V",), {"supply_voltage": FLOAT64}, "supply_voltage"),
    "temperature": SignalName(("degC",), {"temperature": FLOAT64}, "temperature"),
    "enabled": SignalName(("1",), {"enabled": BOOL}, "enabled"),
    "setpoints": SignalName(("rad", "m"), {"setpoints": FLOAT64}, "setpoint"),
}
"""Every signal; a recording is read through these, its clocks and nothing else."""
TIME = "time"
"""What a signal map calls the time of the samples; in a CSV also its column."""
MEASURED = {"hall_voltage": "hall_voltage", "position": "position", "speed": "speed"}
"""Quantity that a signal measures; of several, the first is taken."""
DRIVING = {"applied_duty": "duty", "duty": "duty", "current": "current", "torque": "torque"}
"""Input that a signal gives, likewise: what the plant says it applied comes before what was asked for."""
OPTIONAL = ("supply_voltage", "temperature", "enabled", "setpoints")
"""Signals that a recording may lack."""
FORMER = {"joint_states": "position", "setpoint": "setpoints"}
"""Names by which topics and columns are called and which stand for a signal."""


def in_order(signals: Mapping[str, str], chosen: Collection[str], preferred: Collection[str]) -> list[str]:
    """`signals` by what they give: those that a person chose and no others, if any; the `preferred` ones first."""
    return sorted(
        [each for each in signals if each in chosen] or signals, key=lambda each: signals[each] not in preferred
    )


def signal_of(name: str) -> str:
    """The signal that `name` stands for; `name` itself where it stands for none."""
    return FORMER.get(name, name)


def last_name(topic: str) -> str:
    """`/bench/hall_voltage` -> `hall_voltage`."""
    return topic.rsplit("/", 1)[-1]
