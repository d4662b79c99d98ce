"""Slips in a description: single numbers in another unit, wrong signs, and ranges that a fit cannot use."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from pierburg_ros.actuators import Actuator
from pierburg_ros.identification.description.derived import Derived, derived

PREFIXES = {1e-3: "thousandths", 1e3: "thousands"}
OTHERS = {
    "kg.m^2": {1e-3: "g.m^2", 1e-4: "kg.cm^2", 1e-7: "g.cm^2"},
    "N.m": {1e-3: "mN.m", 1e-2: "N.cm", 0.0981: "kgf.cm"},
    "N.m/A": {1e-3: "mN.m/A", 1e-2: "N.cm/A", 0.0981: "kgf.cm/A"},
    "N.m/rad": {1e-3: "mN.m/rad", 180.0 / math.pi: "N.m/degree", math.pi / 180.0: "N.m/rad taken for N.m/degree"},
}
"""By unit: the factors of numbers written in other units. Given: by the units that data sheets use."""
MAGNITUDES = (
    "armature_resistance", "torque_constant", "gear_ratio", "spring_stiffness", "gravity_torque", "coulomb_friction",
    "total_inertia", "supply_voltage",
)  # fmt: skip
"""Numbers that are negative in no actuator."""


@dataclass(frozen=True)
class Remark:
    """Something in a description that a person should check."""

    about: str
    what: str


def remarks(actuator: Actuator) -> list[Remark]:
    """The implausible numbers, and the single slips that would explain them all."""
    wrong = [each for each in derived(actuator) if not each.plausible]
    found = [Remark(each.name, _told(each)) for each in wrong]
    if wrong:
        found += [Remark(name, what) for name, what in _slips(actuator)]
    return [*found, *_of_signs(actuator), *_of_ranges(actuator)]


def _told(each: Derived) -> str:
    unit = "" if each.unit == "1" else f" {each.unit}"
    return f"{each.value:.3g}{unit}, of real actuators {each.least:g} to {each.most:g}{unit}. {each.reason}"


def _slips(actuator: Actuator) -> Iterator[tuple[str, str]]:
    """Each number that makes every derived number plausible if only its unit is changed."""
    for name, parameter in actuator.parameters.items():
        for factor, written in OTHERS.get(parameter.unit, PREFIXES).items():
            other = factor * parameter.nominal
            low, high = min(parameter.minimum, other), max(parameter.maximum, other)
            changed = replace(parameter, default=other, minimum=low, maximum=high)
            likely = replace(actuator, parameters={**actuator.parameters, name: changed})
            if parameter.nominal > 0.0 and all(each.plausible for each in derived(likely)):
                yield (
                    name,
                    f"{parameter.nominal:g} {parameter.unit}: with {other:.4g} all is plausible"
                    f" (were they {written}?).",
                )


def _of_signs(actuator: Actuator) -> Iterator[Remark]:
    for name in MAGNITUDES:
        parameter = actuator.parameters.get(name)
        if parameter is not None and parameter.nominal < 0.0:
            yield Remark(name, f"{parameter.nominal:g} {parameter.unit} is negative; expected a magnitude.")
    ends = [actuator.parameters.get(f"hall_voltage_{end}") for end in ("closed", "open")]
    if ends[0] is not None and ends[1] is not None and ends[0].nominal > ends[1].nominal:
        yield Remark(
            "hall_voltage_open", "It is below hall_voltage_closed: the sensor then falls while the shaft opens."
        )


def _of_ranges(actuator: Actuator) -> Iterator[Remark]:
    """Parameters that a fit may change but cannot move both ways."""
    for name, parameter in actuator.parameters.items():
        at_end = parameter.nominal in (parameter.minimum, parameter.maximum)
        if parameter.free and at_end and parameter.nominal != 0.0:
            value = f"{parameter.nominal:g} {parameter.unit}"
            yield Remark(name, f"{value} is an end of its range; a fit cannot move it both ways.")
