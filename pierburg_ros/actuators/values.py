"""Which values the numbers of an actuator may have: the one place that every reader and every command asks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from numbers import Real

from pierburg_ros.actuators.actuator import Actuator
from pierburg_ros.effects import ADDED, DECLARED, EFFECT, EFFECTS, GEARED
from pierburg_ros.errors import InputError, near

PAIRS = {name: p for name, p in DECLARED.items() if p.above is not None or p.below is not None}
"""Parameters of effects that keep above or below a base parameter."""
TOLD_APART = 1e-6
"""Least difference of the Hall voltages at the stops, relative to the larger one: a converter of 20 bits tells it."""


def described(actuator: Actuator) -> dict[str, float]:
    """The values of an actuator as described, by dotted name, absent effects 0; InputError where they cannot be."""
    values = {name: p.nominal for name, p in actuator.parameters.items()}
    values.update({f"{effect.id}.{name}": 0.0 for effect in EFFECTS for name in effect.names})
    for effect, numbers in actuator.effects.items():
        for name, value in numbers.items():
            check(actuator, f"{effect}.{name}", value)
            values[f"{effect}.{name}"] = value
    check_together(actuator, values)
    return values


def accepted(actuator: Actuator, name: str) -> tuple[float, float]:
    """Range of the parameter called `name`, 0 included where that is absence; InputError where there is none."""
    if name in actuator.parameters:
        parameter = actuator.parameters[name]
        return parameter.minimum, parameter.maximum
    if name not in DECLARED:
        raise InputError(
            f"There is no parameter {name} in actuator {actuator.name}; expected one of "
            f"{', '.join(actuator.parameters)} or effect.parameter.{near(name, [*actuator.parameters, *DECLARED])}"
        )
    declared = DECLARED[name]
    return min(declared.minimum, 0.0), declared.maximum


def check(actuator: Actuator, name: str, value: object) -> None:
    """Refuse a value that its parameter cannot have."""
    minimum, maximum = accepted(actuator, name)
    declared = actuator.parameters[name] if name in actuator.parameters else DECLARED[name]
    absent = isinstance(value, Real) and not isinstance(value, bool) and value == 0.0 and minimum <= 0.0
    usual = isinstance(value, float) and not declared.choices and minimum <= value <= maximum and math.isfinite(value)
    if not (absent or usual):
        replace(declared, default=None, unit=actuator.unit_of(name), minimum=minimum, maximum=maximum).accepted(
            value, name
        )


def check_together(actuator: Actuator, values: Mapping[str, float]) -> None:
    """Refuse values that cannot go together, or effects that cannot act in this actuator."""
    for effect in EFFECTS:
        if effect.acts(values) and (obstacle := actuator.obstacle(effect)):
            raise InputError(f"{effect.id} cannot act in actuator {actuator.name}: {obstacle}. Leave it out.")
    for name, declared in PAIRS.items():
        value = values[name]
        if value == 0.0:
            continue
        if declared.above is not None and value < values[declared.above]:
            raise InputError(
                f"{name} is {value:g}; expected 0 (absent) or at least {declared.above}, "
                f"{values[declared.above]:g}. Change both together."
            )
        if declared.below is not None and value >= values[declared.below]:
            raise InputError(f"{name} is {value:g}; expected less than {declared.below}, {values[declared.below]:g}.")
    for name, other in ADDED.items():
        if values[name] < -values[other]:
            raise InputError(
                f"{name} is {values[name]:g} and {other} {values[other]:g}; expected a sum of at least 0, since"
                " friction does not drive. Change both together."
            )
    for name, most in GEARED.items():
        periods = values[name] * values.get("gear_ratio", 1.0)
        if periods > most and EFFECT[name.partition(".")[0]].acts(values):
            raise InputError(
                f"{name} is {values[name]:g} and gear_ratio {values['gear_ratio']:g}, {periods:g} in one turn of the"
                f" output; expected {most:g} at most. Lower one of them."
            )
    ends = [values.get(f"hall_voltage_{end}", at) for end, at in (("closed", 0.0), ("open", 1.0))]
    if abs(ends[1] - ends[0]) <= TOLD_APART * max(map(abs, ends)):
        raise InputError(
            f"hall_voltage_closed and hall_voltage_open are both {ends[0]:g}; expected two voltages, which tell the"
            " closed stop from the open one."
        )
