"""A signal map to edit: what was guessed, line by line, with the reasons and with what else it could be."""

from __future__ import annotations

import json
from collections.abc import Iterable

import numpy as np

from pierburg_ros.errors import printable
from pierburg_ros.recording.inspection.guesses import BY_RANGE, Guess, by_signal, is_still
from pierburg_ros.recording.inspection.table_time import TimeGuess
from pierburg_ros.recording.signals import DRIVING, MEASURED, OPTIONAL

HEAD = """\
# Signal map of {name}. Every line is a guess with its reason: check names, units and signs, and edit.
# value = sign * unit * scale * raw + offset, in SI. A line behind a # is another possibility, or was not needed.{joint}
"""
JOINT = "\n# Of the joints it is {joint}, which moves furthest; write another name in its place to read that one."
MOST_OTHERS = 5
"""Other possibilities of a signal that are listed."""


def draft(name: str, guesses: Iterable[Guess], time: TimeGuess | None, is_table: bool) -> str:
    """The text of a signal map of the recording `name`, of a table or of topics."""
    joint, own = of_one_joint(list(guesses))
    found = by_signal(own)
    lines = [HEAD.format(name=printable(name), joint=JOINT.format(joint=printable(joint)) if joint else "")]
    lines += group(found, tuple(DRIVING), "an input (duty, current or torque)")
    lines += group(found, tuple(MEASURED), "a measured signal (hall_voltage, position or speed)")
    for signal in OPTIONAL:
        lines += [entry(each, place > 0) for place, each in enumerate(found.get(signal, [])[: 1 + MOST_OTHERS])]
    if time is not None:
        names = [quoted(name) for name in time.columns]
        column = names[0] if len(names) == 1 else f"[{', '.join(names)}]"
        unit = f", unit: {time.unit}" if time.unit and len(time.columns) == 1 else ""
        lines.append(f"time: {{column: {column}{unit}}}  # {printable(time.reason)}")
    elif is_table:
        lines.append("# time: no column rises from row to row. Name it: time: {column: NAME, unit: s}")
    return "\n".join(lines) + "\n"


def of_one_joint(guesses: list[Guess]) -> tuple[str, list[Guess]]:
    """The joint that moves furthest, empty where there are not several, and the guesses without those of the others."""
    positions = [each for each in guesses if each.element and each.signal == "position"]
    joints = {each.element for each in positions}
    if len(joints) < 2:
        return "", guesses
    furthest = max(positions, key=lambda each: np.ptp(each.field.limits or 0.0)).element
    return furthest, [each for each in guesses if each.element not in joints - {furthest}]


def group(found: dict[str, list[Guess]], signals: tuple[str, ...], wanted: str) -> list[str]:
    """The lines of signals of which one is needed; the others are possibilities.

    It is the first of `signals` that moves and has its name, or else that has such a range.
    """
    several = [each for signal in signals for each in found.get(signal, [])]
    several.sort(key=lambda each: (is_still(each), each.rank == BY_RANGE))
    if not several:
        return [
            f"# Nothing looks like {wanted}. Write one, as"
            f" {signals[-1]}: {{topic: /name, field: path}} or {signals[-1]}: {{column: NAME}}"
        ]
    return [entry(each, place > 0) for place, each in enumerate(several[: 1 + MOST_OTHERS])]


def entry(each: Guess, is_other: bool) -> str:
    """One line of the map."""
    place = "topic" if each.field.path else "column"
    parts = [f"{place}: {quoted(each.field.name)}"]
    if each.field.path:
        parts.append(f"field: {quoted(each.field.path)}")
    if each.field.file:
        parts.append(f"file: {quoted(each.field.file)}")
    if each.unit != "1":
        parts.append(f"unit: {each.unit}")
    if each.scale != 1.0:
        parts.append(f"scale: {each.scale!r}")
    if each.offset:
        parts.append(f"offset: {each.offset!r}")
    return f"{'# ' if is_other else ''}{each.signal}: {{{', '.join(parts)}}}  # {printable(str(each))}"


def quoted(name: str) -> str:
    """A name in quotes, for YAML; what does not print stands as an escape."""
    return json.dumps(name, ensure_ascii=not name.isprintable())
