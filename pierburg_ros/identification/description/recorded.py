"""A description from a recording: numbers that it determines are identified, the others are marked as guessed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pierburg_ros.actuators import Actuator
from pierburg_ros.errors import InputError
from pierburg_ros.identification.identifiability import Finding
from pierburg_ros.identification.identify import Identification, identify
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

LIKE = {
    ("duty", "hall_voltage"): "pierburg",
    ("duty", "position"): "xl330",
    ("torque", "position"): "ak80",
    ("current", "position"): "odrive",
}
"""The shipped actuator to start from, by the input and the measured quantity of a recording."""


def alike(recording: Recording) -> str:
    """The shipped actuator to start from; InputError where none is of this kind."""
    try:
        return LIKE[recording.input, recording.quantity]
    except KeyError:
        raise InputError(
            f"{recording.name} holds {recording.input} and {recording.quantity}, and no shipped actuator is of that"
            " kind; expected --like FILE, a description to start from. Or answer its questions, without"
            " --from-recording."
        ) from None


def identified(recording: Recording, start: Actuator, name: str, jobs: int | None = None) -> dict[str, Any]:
    """The content of a description of the recorded actuator, started from `start`."""
    found = identify(Model.nominal(start), [recording], jobs=jobs)
    values = found.fitted.model.values
    stops = {"lower": start.lower_stop, "upper": start.upper_stop} if start.has_stops else None
    parameters = {each: _entry(found, start, each, recording.name) for each in start.parameters}
    effects = {effect: {own: values[f"{effect}.{own}"] for own in numbers} for effect, numbers in start.effects.items()}
    content = {"name": name, "title": f"{name}, from {recording.name}", "drive": start.drive, "load": start.load}
    content |= {"sensor": start.quantity, "motion": start.motion}
    return {**content, **({"stops": stops} if stops else {}), "parameters": parameters, "effects": effects}


def _entry(found: Identification, start: Actuator, name: str, recording: str) -> Mapping[str, Any]:
    declared, finding = start.parameters[name], found.findings[name]
    value = found.fitted.model.values[name]
    entry = {
        "nominal": float(f"{value:.6g}"),
        "minimum": min(declared.minimum, value),
        "maximum": max(declared.maximum, value),
        "origin": _origin(finding, name in found.fitted.names, start.name, recording),
    }
    return entry if declared.free else entry | {"free": False}


def _origin(finding: Finding, fitted: bool, start: str, recording: str) -> str:
    if fitted and finding.identifiable and finding.half_width is not None:
        return f"identified from {recording}, +-{100.0 * finding.half_width:.2g} % (95 %)"
    if fitted:
        return f"guess: fitted to {recording}, which does not tell it from others; {finding.reason}"
    return f"guess: that of {start}; {recording} does not tell it"
