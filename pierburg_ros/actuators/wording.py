"""How people read what an actuator is driven by and what it does: titles of axes, and places on its travel."""

from __future__ import annotations

import math

from pierburg_ros.actuators.units import Motion, unit_of

QUANTITIES = {"hall_voltage": "Hall voltage", "position": "position", "speed": "speed"}
"""Each measured quantity, in words."""
INPUTS = {"duty": ("duty", "%"), "current": ("current", "A"), "torque": ("torque", "N.m")}
"""Each input, in words, with the unit in which it is drawn."""


def quantity_title(quantity: str, unit: str) -> str:
    """Title of an axis of a measured quantity."""
    return f"{QUANTITIES[quantity]} [{unit}]"


def torque_word(motion: Motion) -> str:
    """What moves the output: a torque, or the force of a linear actuator."""
    return "force" if motion == "linear" else "torque"


def input_title(driven_by: str, motion: Motion) -> str:
    """Title of an axis of an input."""
    word, unit = INPUTS[driven_by]
    return f"{torque_word(motion) if word == 'torque' else word} [{unit_of(unit, motion)}]"


def drawn_factor(driven_by: str) -> float:
    """What an input is multiplied by to be drawn: a duty in per cent."""
    return 100.0 if driven_by == "duty" else 1.0


def travel_factor(motion: Motion) -> float:
    """What a place on the travel [rad or m] is multiplied by to be drawn: an angle in degrees."""
    return math.degrees(1.0) if motion == "rotary" else 1.0


def travel_title(motion: Motion) -> str:
    """Title of an axis of places on the travel."""
    return "angle [degrees]" if motion == "rotary" else "position [m]"


def place(low: float, high: float, motion: Motion) -> str:
    """A range of the travel [rad or m]: in degrees, or in millimetres."""
    factor, unit = (math.degrees(1.0), "degrees") if motion == "rotary" else (1e3, "mm")
    ends = [f"{factor * end:.0f}" if motion == "rotary" else f"{factor * end:.3g}" for end in (low, high)]
    ends = ["0" if end == "-0" else end for end in ends]
    return f"{ends[0]} {unit}" if ends[0] == ends[1] else f"{ends[0]} to {ends[1]} {unit}"
