"""The table of faults: each is what someone wrote down wrongly, and the balance of torques once that is undone.

A fault is a row. A new one is one line here; nothing else names it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.held import PAST_STOP, Held, Weighed
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import Model, simulate
from pierburg_ros.recording import Channel, Recording

LATE_COMMAND = 20.0
"""Time by which a command may be stamped late, at once or by the end, in the actuator's own. Chosen: 2 s for the valve;
not varied."""
BURSTS = 10.0
"""Times that the mean interval is longer than the usual one where samples were stamped as they were written, many at
once. Derived: else nine tenths of the time have no sample."""
CHANNELS = ("command", "supply_voltage", "enabled", "setpoints")
ANGLES = {
    "degrees read as radians": ("deg", math.pi / 180.0),
    "radians read as degrees": ("", 180.0 / math.pi),
    "turns read as radians": ("rev", math.tau),
}
SPEEDS = {"rpm read as rad/s": ("rpm", math.tau / 60.0)}
THOUSANDS = {"thousandths read as whole units": ("", 1e-3), "whole units read as thousandths": ("", 1e3)}
TIMES = {"ms": ("s", 1e-3), "us": ("s", 1e-6), "ns": ("s", 1e-9), "s": ("ms", 1e3)}
"""What is meant, what it is read as, and the factor that mends it."""


@dataclass(frozen=True)
class Row:
    """A fault of a `signal`: what is said of it, what mends it, and what the balance leaves once it is undone.

    One of times is looked for in a signal that is said to be exact, too.
    """

    signal: str
    what: str
    mend: str
    undone: Callable[[], Weighed]
    of_times: bool = False


def rows(held: Held) -> Iterator[Row]:
    """Every fault that a recording may have, of which one is told where several do as well: the first."""
    yield from of_command(held)
    yield from of_sensor(held)
    yield from of_time(held)
    supply = held.recording.supply_voltage
    if supply is not None:
        yield linear(held, "supply_voltage", "millivolts read as volts", 1e-3, unit="mV")
    if held.recording.input != "duty" or float(np.max(np.abs(held.recording.measured))) <= 1.0:
        yield exchanged(held)


def of_command(held: Held) -> Iterator[Row]:
    """Its sign and scale, and a setpoint in its place."""
    recording, actuator = held.recording, held.nominal.actuator
    name, values = recording.input, recording.command.values
    yield linear(held, name, "polarity reversed", -1.0)
    if name != "duty":
        for what, (unit, scale) in THOUSANDS.items():
            yield linear(held, name, what, scale, unit=unit)
    elif 100.0 * float(np.max(np.abs(values))) <= 1.0:
        yield linear(held, name, "a hundredth of the fraction", 100.0)
    if name == "duty" and float(np.min(values)) >= 0.0:
        yield linear(held, name, "0.5 stands for none", 2.0, -1.0)
    travel = actuator.upper_stop - actuator.lower_stop
    mend = f"name the applied {name}: `{name}: {{topic: ...}}`"
    for gain in (1.0, 1.0 / travel) if recording.quantity != "speed" else ():
        if gain > 0.0:
            yield Row(name, f"a setpoint in place of the {name}", mend, partial(held.followed, gain))


def of_sensor(held: Held) -> Iterator[Row]:
    """Its sign, unit and zero."""
    recording, nominal = held.recording, held.nominal
    name, measured = recording.quantity, recording.measured
    closed, opened = ends(held)
    if name == "hall_voltage":
        yield linear(held, name, "polarity reversed", -1.0, closed + opened)
    yield linear(held, name, "negated" if name == "hall_voltage" else "polarity reversed", -1.0)
    turning = name != "hall_voltage" and nominal.actuator.motion == "rotary"
    units = (SPEEDS if name == "speed" else ANGLES) if turning else {}
    for what, (unit, scale) in units.items():
        yield linear(held, name, what, scale, unit=unit)
    if np.array_equal(measured, np.round(measured)):
        for bits in (8, 10, 12, 13, 14, 16):
            for full in (3.3, 5.0) if name == "hall_voltage" else (math.tau,):
                what = f"counts read as {recording.unit} ({bits} bit over {full:.4g})"
                yield linear(held, name, what, full / (2**bits - (name == "hall_voltage")))
    for what, (unit, scale) in THOUSANDS.items():
        yield linear(held, name, what, scale, unit=unit)
    if turning and (gear := nominal.values.get("gear_ratio", 1.0)) != 1.0:
        yield linear(held, name, "of the motor, before the gear", 1.0 / gear)
    if math.isfinite(opened - closed) and name != "speed":
        low, high = np.percentile(measured, [1.0, 99.0])
        for scale in (2.0, 0.5):
            yield linear(held, name, f"scale off by {1.0 / scale:g}", scale)
        for read, true in ((low, closed), (high, opened)):
            yield linear(held, name, f"zero off by {read - true:.4g}", 1.0, float(f"{true - read:.4g}"))


def of_time(held: Held) -> Iterator[Row]:
    """Its unit, the stamps of the command, and its clock."""
    recording, name = held.recording, held.recording.input
    clock = recording.clock.line if recording.clock else "time: {{unit: {}}}".format
    for unit, (read, scale) in TIMES.items():
        undone = partial(reread, timed(recording, scale), held.nominal)
        yield Row("time", f"{unit} read as {read}", f"`{clock(unit)}`", undone, True)
    if held.motion is None:
        return
    own = held.nominal.scales.time
    step, most = max(held.motion.step, own / 4.0), LATE_COMMAND * own
    sender = f"choose the clock of the sender with --time stamp or --time publish, or record the applied {name}"
    for late in map(float, np.arange(step, most, step)):
        yield Row(name, f"stamped {1e3 * late:.3g} ms late", sender, partial(held.weighed, late), True)
    one = f"stamp {name} and {recording.quantity} by one clock: choose it with --time stamp, publish or log"
    for drift in map(float, np.arange(2.0 * step, most, 2.0 * step)):
        for way, rate in (("fast", drift / recording.duration), ("slow", -drift / recording.duration)):
            yield Row(name, f"clock {100.0 * abs(rate):.2g} % {way}", one, partial(held.weighed, 0.0, rate), True)


def exchanged(held: Held) -> Row:
    """Command and sensor one for the other."""
    recording = held.recording
    one, other = (recording.source(signal) for signal in (recording.input, recording.quantity))
    mend = f"`{other[1].line(one[0])}` and `{one[1].line(other[0])}`"
    command = Channel(recording.time, recording.measured)
    changed = replace(recording, measured=recording.command.at(recording.time), command=command, losses=())
    what = f"{recording.input} and {recording.quantity} exchanged"
    return Row(recording.quantity, what, mend, partial(reread, changed, held.nominal))


def linear(held: Held, signal: str, what: str, scale: float, offset: float = 0.0, unit: str = "") -> Row:
    """A signal that has to be read as scale * value + offset, and the line of the signal map that does it."""
    recording = held.recording
    name, source = recording.source(signal)
    mend = f"`{source.mended(scale, offset, unit).line(name)}`"
    if signal == recording.quantity:
        changed = replace(recording, measured=scale * recording.measured + offset)
    else:
        role = "command" if signal == recording.input else signal
        channel: Channel = getattr(recording, role)
        one: dict[str, Any] = {role: Channel(channel.time, scale * channel.values + offset)}
        changed = replace(recording, **one)
    return Row(signal, what, mend, partial(reread, changed, held.nominal))


def timed(recording: Recording, unit: float) -> Recording:
    """The recording with times that are counted in `unit` [s]."""
    channels: dict[str, Any] = {
        name: Channel(unit * channel.time, channel.values)
        for name in CHANNELS
        if (channel := getattr(recording, name)) is not None
    }
    return replace(recording, time=unit * recording.time, losses=(), **channels)


def ends(held: Held) -> tuple[float, float]:
    """What the sensor gives at the lower and the upper stop."""
    values, actuator = held.nominal.values, held.nominal.actuator
    if held.recording.quantity == "hall_voltage":
        return values["hall_voltage_closed"], values["hall_voltage_open"]
    return actuator.lower_stop, actuator.upper_stop


def reread(changed: Recording, nominal: Model) -> Weighed:
    """What another recording leaves."""
    return Held(changed, nominal).as_read()


def facts(held: Held) -> Iterator[Fault]:
    """Every fault that shows in a signal by itself."""
    recording, nominal = held.recording, held.nominal
    name, values = recording.input, recording.command.values
    still, unsteered = np.ptp(recording.measured) == 0.0, np.ptp(values) == 0.0
    step, mean = float(np.median(np.diff(recording.time))), recording.duration / (recording.time.size - 1)
    if mean > BURSTS * step:
        shown = f"Half of the samples come {step:.2g} s after the one before, {mean:.2g} s apart on average."
        mend = "stamp each sample when it is taken, or write a time column with even steps where they were even"
        yield Fault(recording.name, "time", "stamped in bursts", shown, mend)
    applied, sensed = (f"name the signal: `{each}: {{topic: ...}}`" for each in (name, recording.quantity))
    if still and np.ptp(simulate(nominal, inputs_of(recording), recording.time)) > PAST_STOP * nominal.scales.reading:
        shown = f"It reads {recording.measured[0]:.4g} throughout, while the {name} would move the actuator."
        yield Fault(recording.name, recording.quantity, "constant", shown, sensed)
    swings = nominal.actuator.load == "pendulum" or recording.enabled is not None
    if unsteered and not swings and held.motion is not None and np.ptp(held.motion.direction) > 0.0:
        shown = f"It is {values[0]:.4g} throughout, while the shaft moves to and fro."
        yield Fault(recording.name, name, "constant", shown, applied)
    wanted = None if recording.setpoints is None else recording.setpoints.at(recording.command.time)
    if wanted is not None and not unsteered and np.array_equal(wanted, values):
        what = f"a setpoint in place of the {name}"
        yield Fault(recording.name, name, what, "It equals the recorded setpoints.", applied)
