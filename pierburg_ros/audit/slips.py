"""The slips that are looked for: each is what someone wrote down wrongly, and the change of a signal that undoes it.

A slip is data. A new one is one line here; nothing else names it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model

INSIDE = 0.05
"""Share of the span by which lowest and highest reading may miss the ends that they are taken for. Chosen: sensors are
set less well than that by nobody, and a wrong divider is off by a third."""


ANY: dict[str, tuple[str | None, float]] = {
    "thousandths read as whole units": (None, 1e-3),
    "whole units read as thousandths": (None, 1e3),
}
TURNING: dict[str, tuple[str | None, float]] = {
    "degrees read as radians": ("deg", math.pi / 180.0),
    "radians read as degrees": (None, 180.0 / math.pi),
    "turns read as radians": (None, math.tau),
}
SPINNING: dict[str, tuple[str | None, float]] = {"rpm read as rad/s": ("rpm", math.tau / 60.0)}
"""Other units of a position or speed, of any actuator and of one that turns: the unit as a signal map calls it, if it
does, and what one of it is."""


@dataclass(frozen=True)
class Slip:
    """What may be wrong with a signal, the line of the signal map that mends it, and the signals as they then are."""

    signal: str
    what: str
    mend: str
    mended: Signals


Change = Callable[[Signals], Signals]


def slips(signals: Signals, nominal: Model) -> Iterator[Slip]:
    """Every slip with a name that these signals may hold."""
    yield from _of_input(signals)
    yield from _of_sensor(signals, nominal)
    yield from _of_time(signals)
    yield from exchanged(signals)
    if signals.inputs.supply_voltage is not None:
        yield _mapped("supply_voltage", "millivolts read as volts", "scale: 0.001", signals.supplied_with(1e-3))


def _of_input(signals: Signals) -> Iterator[Slip]:
    name = signals.input
    yield _mapped(name, "polarity reversed", "sign: -1", signals.driven_by(-1.0))
    if name == "duty":
        yield _mapped(name, "a hundredth of the fraction", "scale: 100", signals.driven_by(100.0))
        if np.min(signals.inputs.command) >= 0.0:
            yield _mapped(name, "0.5 stands for no duty", "scale: 2, offset: -1", signals.driven_by(2.0, -1.0))
        return
    yield _mapped(name, "thousandths read as whole units", "scale: 0.001", signals.driven_by(1e-3))
    yield _mapped(name, "whole units read as thousandths", "scale: 1000", signals.driven_by(1e3))


def _of_sensor(signals: Signals, nominal: Model) -> Iterator[Slip]:
    name = signals.quantity
    if name == "hall_voltage":
        yield from _of_voltage(signals, nominal)
        return
    yield _mapped(name, "polarity reversed", "sign: -1", signals.measured_as(-1.0))
    gear = nominal.values.get("gear_ratio", 1.0)
    others = (SPINNING if name == "speed" else TURNING) if nominal.actuator.motion == "rotary" else {}
    if gear != 1.0:
        others = {**others, "of the motor, before the gear": (None, 1.0 / gear)}
    for what, (unit, scale) in {**ANY, **others}.items():
        yield _mapped(name, what, f"unit: {unit}" if unit else f"scale: {scale:.6g}", signals.measured_as(scale))
    for bits in (10, 12, 13, 14, 16) if _is_counted(signals) else ():
        scale = math.tau / 2**bits
        what = f"counts read as radians ({2**bits} a turn)"
        yield _mapped(name, what, f"scale: {scale:.6g}", signals.measured_as(scale))


def _of_voltage(signals: Signals, nominal: Model) -> Iterator[Slip]:
    ends = nominal.values["hall_voltage_closed"] + nominal.values["hall_voltage_open"]
    name = signals.quantity
    reversed_ = f"sign: -1, offset: {ends:.6g}"
    yield _mapped(name, "polarity reversed", reversed_, signals.measured_as(-1.0, ends))
    yield _mapped(name, "negated", "sign: -1", signals.measured_as(-1.0))
    yield _mapped(name, "millivolts read as volts", "scale: 0.001", signals.measured_as(1e-3))
    yield _mapped(name, "volts read as millivolts", "scale: 1000", signals.measured_as(1e3))
    for bits in (8, 10, 12, 16) if _is_counted(signals) else ():
        for full in (3.3, 5.0):
            scale = full / (2**bits - 1)
            what = f"counts read as volts ({bits} bit over {full:g} V)"
            yield _mapped(name, what, f"scale: {scale:.6g}", signals.measured_as(scale))


def between_stops(signals: Signals, nominal: Model) -> Iterator[Slip]:
    """A scale or a zero with which the lowest reading lies on one stop, or the highest on the other."""
    low, high = np.percentile(signals.measured, [1.0, 99.0])
    ends = _ends(signals, nominal)
    if high == low or not np.all(np.isfinite(ends)):
        return
    name, span = signals.quantity, ends[1] - ends[0]
    for read, true in ((low, ends[0]), (high, ends[1])):
        offset = true - read
        mend = f"offset: {offset:.4g}"
        if abs(offset) > INSIDE * abs(span):
            yield _mapped(name, f"zero off by {-offset:.4g}", mend, signals.measured_as(1.0, offset))
        if read != 0.0 and true / read > 0.0 and abs(true / read - 1.0) > INSIDE:
            scale = true / read
            yield _mapped(name, f"scale off by {1.0 / scale:.4g}", f"scale: {scale:.4g}", signals.measured_as(scale))
    scale = span / (high - low)
    offset = ends[0] - scale * low
    if scale > 0.0:
        yield _mapped(
            name,
            "scale and zero wrong",
            f"scale: {scale:.4g}, offset: {offset:.4g}",
            signals.measured_as(scale, offset),
        )


def _ends(signals: Signals, nominal: Model) -> tuple[float, float]:
    """What the sensor gives at the lower and the upper stop."""
    if signals.quantity == "hall_voltage":
        return nominal.values["hall_voltage_closed"], nominal.values["hall_voltage_open"]
    return nominal.actuator.lower_stop, nominal.actuator.upper_stop


def _of_time(signals: Signals) -> Iterator[Slip]:
    for unit, scale, name in (("ms", 1e-3, "milliseconds"), ("us", 1e-6, "microseconds"), ("ns", 1e-9, "nanoseconds")):
        yield _mapped("time", f"{name} read as seconds", f"unit: {unit}", signals.timed_in(scale))
    yield _mapped("time", "seconds read as milliseconds", "unit: s", signals.timed_in(1e3))


def exchanged(signals: Signals) -> Iterator[Slip]:
    """Input and measured signal one for the other, where each can be the other."""
    other = signals.exchanged()
    if other is not None:
        name, measured = signals.input, signals.quantity
        what = f"{name} and {measured} exchanged"
        yield Slip(measured, what, f"name each in place of the other: `{name}: ...`, `{measured}: ...`", other)


def _mapped(signal: str, what: str, entries: str, mended: Signals) -> Slip:
    return Slip(signal, what, f"`{signal}: {{{entries}}}`", mended)


def _is_counted(signals: Signals) -> bool:
    """Whether every value is a whole number, and not always the same few."""
    values = signals.measured
    return bool(np.all(values == np.round(values)) and np.ptp(values) > 20.0)
