"""What a number could be: a signal and its unit, guessed from its name, its type and its range, with the reason."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.recording.formats.cdr import JOINT_STATE
from pierburg_ros.recording.inspection.fields import Field
from pierburg_ros.recording.signals import MEASURED, SIGNALS, last_name
from pierburg_ros.recording.units import COUNTS, unit_of

WORDS = {
    "enabled": {"enabled", "enable", "powered", "on"},
    "temperature": {"temperature", "temp"},
    "duty": {"duty", "pwm", "throttle", "dutycycle"},
    "supply_voltage": {"vbat", "ubat", "bat", "batt", "battery", "vbus", "vdc", "udc", "supply", "vin"},
    "hall_voltage": {"hall", "adc", "ain", "analog", "sensor"},
    "current": {"current", "cur", "iq", "i", "amps", "amperes"},
    "torque": {"torque", "tau", "effort", "efforts", "moment"},
    "speed": {"velocity", "velocities", "vel", "speed", "omega", "rpm", "dq", "qd", "dot"},
    "position": {"position", "positions", "pos", "angle", "theta", "phi", "encoder", "enc", "q", "winkel"},
}
"""Words in the name of a topic, field or column that speak for a signal; the first that matches counts."""
UNIT_WORDS = {
    "percent": "percent", "pct": "percent", "deg": "deg", "degrees": "deg", "rad": "rad", "rpm": "rpm", "mv": "mV",
    "ma": "mA", "mnm": "mN.m", "nm": "N.m", "volt": "V", "degc": "degC", "counts": "counts", "ticks": "counts",
}  # fmt: skip
"""Words in a name that tell a unit."""
SIGNAL_OF_UNIT = {
    "percent": "duty", "deg": "position", "rad": "position", "rpm": "speed", "mA": "current", "mN.m": "torque",
    "N.m": "torque", "degC": "temperature",
}  # fmt: skip
"""What a unit speaks for where no other word does."""
SETPOINTS = {"setpoint", "setpoints", "target", "reference", "ref", "desired", "goal", "wanted"}
"""Words that speak for what is wanted, where no other says of what, of a position."""
COMMANDS = {"command", "commands", "cmd"}
"""Words that speak for what is sent: a position, or a duty."""
OUTPUT = "output"
"""The word in a path for what a controller sends."""
UNSAID = {"feedback": "position", OUTPUT: "torque"}
"""What these words in the state of a controller are taken for where no other says of what they are."""
UNNAMED = {"data", "value", "values"}
"""Names of fields that say nothing, so that the topic's name counts as theirs."""
NO_SIGNALS = {"error", "errors", "acceleration", "accelerations", "layout", "scaling"}
"""Words in a path or a topic for what is no signal."""
IN_SI = {"sensor_msgs", "control_msgs", "trajectory_msgs"}
"""Packages whose joints are in radian (REP 103)."""
TIMES = {"sec", "nanosec", "secs", "nsecs", "micros", "millis", "stamp", "timestamp", "time", "seq", "us", "ns", "ms"}
"""Words in the name of a time or a number of messages, which is no signal."""
TURN = 2.0 * math.pi
LARGEST_DEGREES = 400.0
"""Angles beyond two turns [rad] up to here are taken for degrees."""
CONVERTERS = (255, 1023, 4095, 16_383, 32_767, 65_535)
"""Largest counts of converters and timers of 8 to 16 bits."""
CONVERTER_VOLTAGE = 3.3
"""Full scale [V] of most converters of microcontrollers."""
MOST_OF_SENSORS = 6.0
"""Voltage [V] up to which one without another name is taken for a sensor's; supplies have more."""
BY_RANGE = 3
"""Rank of a guess from the range alone; those from the last word of a path, its others, and the topic are 0 to 2."""


@dataclass(frozen=True)
class Guess:
    """What a field could be: the signal, what to write into a map, and why; `rank` says how well it is founded.

    `element` is the joint or other named element that it is of, empty where that is not known.
    """

    field: Field
    signal: str
    unit: str
    scale: float
    offset: float
    reason: str
    rank: int
    element: str = ""

    def __str__(self) -> str:
        """As people read it: `0 to 100: duty [percent]?`."""
        unit = {"1": "0 or 1" if self.signal == "enabled" else "fraction"}.get(self.unit, self.unit)
        return f"{self.reason}: {self.signal.replace('_', ' ')} [{unit}]?"


def guess(field: Field) -> Guess | None:
    """What `field` could be; None where nothing speaks for anything, or nothing was sent."""
    if field.limits is None:
        return None
    bare = words(field.bare.rpartition(".")[2] or field.name)
    last = words(field.path.rpartition(".")[2] or field.name)
    own, outer = words(field.path), words(last_name(field.name))
    role = words(field.bare) | (outer - {OUTPUT})
    if role & NO_SIGNALS or (last & TIMES and not last & {"temp", "temperature"}):
        return None
    last = last | outer if bare <= UNNAMED else last
    every = last | own | outer | words(field.name)
    for rank, names in ((0, bare), (0, last), (1, own | last), (2, every)):
        quantity = signal_named(names, field.limits[1], field.unit)
        if quantity is not None:
            signal = asked(quantity, role)
            return known_as(field, signal, rank, last | own | outer) if signal else None
    if role & SETPOINTS and fits("setpoints", field.unit):
        return known_as(field, "setpoints", 0, last | own | outer)
    if field.unit not in ("", COUNTS):
        signal = signal_in(field.unit, field.limits[1])
        return known_as(field, signal, BY_RANGE, set()) if signal else None
    ranged = by_range(field)
    unsaid = next((signal for word, signal in UNSAID.items() if word in bare), None)
    if unsaid is not None:
        return known_as(field, unsaid, 2, set())
    is_command = every & COMMANDS and (ranged is None or ranged.signal != "duty")
    return known_as(field, "setpoints", BY_RANGE, last | own) if is_command else ranged


def signal_named(names: set[str], largest: float, unit: str = "") -> str | None:
    """What words in a name speak for, measured or sent, and a stated `unit` measures.

    A voltage is a sensor's or the supply by its `largest` value.
    """
    for signal, known in WORDS.items():
        if names & known and fits(signal, unit):
            return "applied_duty" if signal == "duty" and "applied" in names else signal
    if names & {"voltage", "volts", "volt"} and fits("hall_voltage", unit):
        return voltage(largest, unit)
    named = (SIGNAL_OF_UNIT[each] for each in units_in(names) if each in SIGNAL_OF_UNIT)
    return None if unit else next(named, None)


def asked(quantity: str, role: set[str]) -> str | None:
    """The signal that a `quantity` is in its `role`: a wanted position is a setpoint, a wanted speed is none."""
    if quantity not in MEASURED or not role & {*SETPOINTS, *COMMANDS, OUTPUT}:
        return quantity
    return "setpoints" if quantity == "position" else None


def fits(signal: str, unit: str) -> bool:
    """Whether a `unit`, if one is stated, measures the signal."""
    return not unit or any(unit_of(unit).measures(each) for each in SIGNALS[signal].units)


def signal_in(unit: str, largest: float) -> str | None:
    """The signal that a stated unit alone speaks for."""
    if fits("hall_voltage", unit):
        return voltage(largest, unit)
    return next((signal for signal in dict.fromkeys(SIGNAL_OF_UNIT.values()) if fits(signal, unit)), None)


def voltage(largest: float, unit: str) -> str:
    """Whether a voltage is a sensor's or the supply, by its largest value."""
    return "hall_voltage" if largest * unit_of(unit or "V").factor <= MOST_OF_SENSORS else "supply_voltage"


def units_in(names: set[str]) -> list[str]:
    """The units among words."""
    return [UNIT_WORDS[name] for name in sorted(names) if name in UNIT_WORDS]


def words(name: str) -> set[str]:
    """The words in a name, small, whole and parted at capitals: `motorPwm_L` -> motorpwm, motor, pwm, l."""
    found = re.findall(r"[^\W\d_]+", name) + re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)
    return {word.lower() for word in found} | ({"percent"} if "%" in name else set())


def known_as(field: Field, signal: str, rank: int, names: set[str]) -> Guess | None:
    """The guess that `field` is `signal`, with the unit that its name or its range speaks for."""
    low, high = field.limits or (0.0, 0.0)
    named = next(iter(units_in(names)), "")
    unit, scale, offset = stated_or(in_unit(field, signal, named, max(abs(low), abs(high))), field.unit)
    if unit == COUNTS and scale == 1.0:
        return None
    told = "JointState, " if field.type == JOINT_STATE else ""
    told += "a torque or a current as its driver says, " if signal == "torque" and "effort" in names else ""
    return Guess(field, signal, unit, scale, offset, f"{told}{low:.4g} to {high:.4g}", rank, field.element)


def stated_or(guessed: tuple[str, float, float], stated: str) -> tuple[str, float, float]:
    """Unit, scale and offset as the table states the unit, or else as `guessed`."""
    if not stated or stated == guessed[0]:
        return guessed
    return stated, 1.0, 0.0


def in_unit(field: Field, signal: str, named: str, largest: float) -> tuple[str, float, float]:
    """Unit, scale and offset of a field that is taken for `signal`; `largest` is its magnitude."""
    counted = field.unit == COUNTS or (field.whole and largest > 100.0)
    if signal in ("duty", "applied_duty"):
        if named == "percent" or (1.0 < largest <= 100.0 and field.unit != COUNTS):
            return "percent", 1.0, 0.0
        is_counted = largest > 100.0 or field.unit == COUNTS
        return (COUNTS, 1.0 / full_scale(largest), 0.0) if is_counted else ("1", 1.0, 0.0)
    if signal in ("position", "setpoints"):
        if field.type.partition("/")[0] in IN_SI or named == "rad":
            return "rad", 1.0, 0.0
        if COUNTS in (named, field.unit) or (counted and largest > LARGEST_DEGREES):
            return COUNTS, TURN / (full_scale(largest) + 1), 0.0
        return ("deg" if named == "deg" or 2.0 * TURN < largest <= LARGEST_DEGREES else "rad"), 1.0, 0.0
    if signal == "speed":
        return (named if named == "rpm" else "deg/s" if named == "deg" else "rad/s"), 1.0, 0.0
    if signal == "hall_voltage":
        if named == "mV" or (largest > 100.0 and not field.whole):
            return "mV", 1.0, 0.0
        return (COUNTS, CONVERTER_VOLTAGE / (full_scale(largest) + 1), 0.0) if counted else ("V", 1.0, 0.0)
    if signal == "supply_voltage":
        return ("mV" if named == "mV" or largest > 1000.0 else "V"), 1.0, 0.0
    if signal == "current":
        return ("mA" if named == "mA" or largest > 200.0 else "A"), 1.0, 0.0
    if signal == "temperature":
        return "degC", 1.0, -273.15 if largest > 200.0 else 0.0
    return (named if signal == "torque" and named in ("mN.m", "N.m") else SIGNALS[signal].units[0]), 1.0, 0.0


def full_scale(largest: float) -> int:
    """The largest count of the converter or timer that gives `largest`."""
    return next((each for each in CONVERTERS if largest <= each), 2 ** math.ceil(math.log2(largest + 1.0)) - 1)


def by_range(field: Field) -> Guess | None:
    """What the range alone speaks for: a converter's counts, or a duty."""
    low, high = field.limits or (0.0, 0.0)
    told = f"{low:.4g} to {high:.4g}"
    if low == high:
        return None
    if field.whole and low >= 0.0 and 255 < high <= CONVERTERS[-1]:
        scale = CONVERTER_VOLTAGE / (full_scale(high) + 1)
        return Guess(field, "hall_voltage", "counts", scale, 0.0, f"{told}, counts of a converter", BY_RANGE)
    if max(abs(low), abs(high)) <= 1.0 and np.unique(field.values).size > 2:
        return Guess(field, "duty", "1", 1.0, 0.0, told, BY_RANGE)
    if max(abs(low), abs(high)) <= 100.0 and max(abs(low), abs(high)) >= 10.0:
        return Guess(field, "duty", "percent", 1.0, 0.0, told, BY_RANGE)
    return None


def by_signal(guesses: Iterable[Guess]) -> dict[str, list[Guess]]:
    """The guesses for each signal, the best founded first, and among equals what moves before what stands still."""
    found: dict[str, list[Guess]] = {}
    for each in guesses:
        found.setdefault(each.signal, []).append(each)
    return {signal: sorted(several, key=lambda each: (is_still(each), each.rank)) for signal, several in found.items()}


def is_still(each: Guess) -> bool:
    """Whether the field has the same value all the time."""
    limits = each.field.limits
    return limits is None or limits[0] == limits[1]
