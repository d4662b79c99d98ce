"""Commands without names, as in a std_msgs/Float64MultiArray: of which joint, and of what, each is by its values."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from pierburg_ros.recording.inspection.fields import Field
from pierburg_ros.recording.inspection.guesses import BY_RANGE, COMMANDS, Guess, words
from pierburg_ros.recording.signals import last_name

ASKED = {"position": "setpoints", "speed": "", "torque": "torque"}
"""The signal that a command is which is like one of these; a wanted speed is none."""
UNLIKE = 0.5
"""Share of a signal's variance by which a command may differ from it: it leads, and steps where the joint glides."""


def likened(guessed: Mapping[Field, Guess | None]) -> dict[Field, Guess | None]:
    """What elements of arrays of commands are, by the signal of a named joint that each is most like.

    Where the topic's name says of what the commands are, only such signals are compared.
    """
    named = [each for each in guessed.values() if each and each.element and each.signal in ASKED]
    found: dict[Field, Guess | None] = {}
    for field, own in guessed.items():
        if field.bare != "data" or field.bare == field.path or not words(last_name(field.name)) & COMMANDS:
            continue
        said = own.signal if own is not None and own.rank < BY_RANGE else None
        apart = {unlikeness(field, each.field): each for each in named if said in (None, ASKED[each.signal])}
        if apart and min(apart) < UNLIKE:
            found[field] = like(field, apart[min(apart)])
    return found


def like(field: Field, other: Guess) -> Guess | None:
    """The guess that `field` commands what `other` is."""
    signal = ASKED[other.signal]
    reason = f"like {other.field.path} of {other.field.name}"
    return Guess(field, signal, other.unit, other.scale, other.offset, reason, 2, other.element) if signal else None


def unlikeness(command: Field, signal: Field) -> float:
    """Mean squared difference of a signal from the command in force, over the signal's variance."""
    place = np.searchsorted(command.time, signal.time, side="right") - 1
    held, values = command.values[place[place >= 0]], signal.values[place >= 0]
    finite = np.isfinite(held) & np.isfinite(values)
    variance = float(np.var(values[finite])) if np.any(finite) else 0.0
    return float(np.mean((held[finite] - values[finite]) ** 2)) / variance if variance > 0.0 else np.inf
