"""Recordings without the samples that say nothing about the actuator, and a note of what was done to them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Flags
from pierburg_ros.diagnosis.cleaning.hum import hum
from pierburg_ros.diagnosis.cleaning.outliers import outliers
from pierburg_ros.diagnosis.cleaning.saturation import saturated
from pierburg_ros.inference.data import unknown_spans
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span, spans_of

SPAN_GAP = 5
"""Largest distance [samples] between left-out samples that belong to one span. Work: each span is an entry."""


@dataclass(frozen=True)
class Omission:
    """A `span` [s] of the recording with this `number` that is left out, and why."""

    number: int
    span: Span
    why: str


@dataclass(frozen=True)
class Cleaned:
    """A cleaned recording, the spans left out of it, and the remarks that are reported first."""

    recording: Recording
    omissions: tuple[Omission, ...] = ()
    remarks: tuple[str, ...] = ()

    def left_out(self, actuator: Actuator) -> list[tuple[float, float, str]]:
        """Spans, from the first sample [s], that no model of an `actuator` is compared with, each with the reason."""
        first = float(self.recording.time[0])
        unknown = [(*span, "the input is unknown there") for span in unknown_spans(self.recording, actuator)]
        spans = (*unknown, *((*omission.span, omission.why) for omission in self.omissions))
        return [(start - first, end - first, why) for start, end, why in spans]


def cleaned(recording: Recording, number: int = 0) -> Cleaned:
    """`recording` without outliers, without samples at the end of the converter's range, and without mains hum."""
    found = Cleaned(recording)
    for clean in (_without_outliers, _without_saturation, _without_hum):
        found = clean(found, number)
    return found


def _without_outliers(given: Cleaned, number: int) -> Cleaned:
    time, measured = given.recording.time, given.recording.measured
    found = outliers(time, measured)
    if not np.any(found):
        return given
    count, size = int(np.count_nonzero(found)), measured.size
    many = "samples" if count > 1 else "sample"
    what = f"{count} single {many} ({100.0 * count / size:.2g} %) far off those around"
    span = (float(time[found][0]), float(time[found][-1]))
    remark = f"{what}, left out: look at cable, connector and supply of the sensor."
    return _added(given, ~found, (Omission(number, span, f"{what}: only these are left out"),), remark)


def _without_saturation(given: Cleaned, number: int) -> Cleaned:
    time, measured = given.recording.time, given.recording.measured
    found = saturated(time, measured, 0.0 if given.recording.quantity == "speed" else None)
    if not np.any(found):
        return given
    unit, ends = given.recording.unit, sorted({float(np.min(measured[found])), float(np.max(measured[found]))})
    what = f"the reading stands at the end of its range ({ends[-1]:.4g} {unit})"
    omissions = tuple(Omission(number, span, what) for span in spans_of(time, found, SPAN_GAP))
    remark = (
        f"For {np.mean(found) * (time[-1] - time[0]):.3g} s {what}: samples there are left out. Choose a converter or"
        " an amplifier with more range."
    )
    return _added(given, ~found, omissions, remark)


def _without_hum(given: Cleaned, number: int) -> Cleaned:
    recording = given.recording
    lines = hum(recording.time, recording.measured)
    if not lines:
        return given
    total = np.sum([line.at(recording.time) for line in lines], axis=0)
    heard = ", ".join(f"{line.amplitude:.2g} {recording.unit} at {line.frequency:.4g} Hz" for line in lines)
    remark = f"The sensor hears the mains ({heard}), also while the shaft stands; that is taken out. Shield its cable."
    humless = replace(recording, measured=recording.measured - total)
    return Cleaned(humless, given.omissions, (*given.remarks, remark))


def _added(given: Cleaned, kept: Flags, omissions: tuple[Omission, ...], remark: str) -> Cleaned:
    recording = given.recording
    rest = replace(recording, time=recording.time[kept], measured=recording.measured[kept])
    return Cleaned(rest, (*given.omissions, *omissions), (*given.remarks, remark))
