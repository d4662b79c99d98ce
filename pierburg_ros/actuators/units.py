"""Units as an actuator's motion makes them: what is declared for turning, said for sliding."""

from __future__ import annotations

from typing import Literal

Motion = Literal["rotary", "linear"]

LINEAR = {
    "rad": "m",
    "rad/s": "m/s",
    "rad/s^2": "m/s^2",
    "N.m": "N",
    "N.m/rad": "N/m",
    "N.m/rad^3": "N/m^3",
    "N.m.s/rad": "N.s/m",
    "N.m.s^2/rad^2": "N.s^2/m^2",
    "N.m.s^3/rad^3": "N.s^3/m^3",
    "kg.m^2": "kg",
    "rad/V": "m/V",
}
"""The linear counterpart of each unit in which an angle or a torque at the output is declared.

Torques at the motor (`torque_constant`, N.m/A) stay: the motor turns whatever moves at the output.
"""


def unit_of(declared: str, motion: Motion) -> str:
    """The unit `declared` for a rotary actuator, as one with this `motion` has it."""
    return LINEAR.get(declared, declared) if motion == "linear" else declared
