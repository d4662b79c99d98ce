"""The result of `pierburg identify`: the paper's procedure beside the fit of whole recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.actuators.units import unit_of
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.identification.fit import Identified
from pierburg_ros.identification.identifiability import Finding, endless, identifiability
from pierburg_ros.identification.paper.lumps import Lump, fitted_duties, fitted_lumps
from pierburg_ros.identification.paper.static_characteristic import (
    StaticCharacteristic,
    static_characteristic,
)
from pierburg_ros.identification.paper.step_response import StepResponse, step_response
from pierburg_ros.identification.reach import fitted
from pierburg_ros.identification.turn import described_turn
from pierburg_ros.inference.replay import resimulated
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of

HELD = ("supply_voltage", "spring_stiffness", "gravity_torque", "sensor_scale", "sensor_offset")
"""Parameters that are held unless freed. The supply can be measured. Input and angle leave the scale of all torques
open. The load would compensate for an error of the sensor."""
TRAINED_SHARE = 0.7
"""Share of a single recording to which the validated fit is made. Given: the usual split, 70 to 30."""


@dataclass(frozen=True)
class Identification:
    """The fit of all recordings, its result for every parameter, and the paper's own procedure beside it.

    `validation_rmse` is that of a second fit on data that it did not use, in the measured unit.
    """

    model: Model
    fitted: Identified
    findings: dict[str, Finding]
    lumps: dict[str, Lump] | None
    static: StaticCharacteristic | None
    steps: StepResponse | None
    validation_rmse: float
    noise: float

    @property
    def repeated(self) -> str | None:
        """The torque in the fitted model that repeats with every turn, in words; None if there is none."""
        residual = self.fitted.model.residual_torque
        if residual is None or self.model.residual_torque is not None:
            return None
        unit = unit_of("N.m", self.model.actuator.motion)
        return f"A torque is part of the model, residual_torque: {described_turn(residual['torque'], unit)}."

    def as_mapping(self) -> dict[str, Any]:
        """The content of identification.json (section 5 of docs/contract.md)."""
        return {
            "schema": 1,
            "parameters": {name: self._parameter(name) for name in self.findings},
            "lumps": self.lumps and {name: _lump(lump) for name, lump in self.lumps.items()},
            "static_characteristic": self._static(),
            "fit": {
                "training": {"rmse": self.fitted.rmse},
                "validation": {"rmse": self.validation_rmse},
            },
        }

    def _parameter(self, name: str) -> dict[str, Any]:
        finding, fixed = self.findings[name], name not in self.fitted.names
        interval = None if fixed or not finding.identifiable else list(self.fitted.ci95[name])
        return {
            "value": self.fitted.model.values[name],
            "unit": self.model.actuator.unit_of(name),
            "ci95": interval,
            "identifiable": finding.identifiable,
            "fixed": fixed,
            **self._fixed_by(name, fixed),
        }

    def _fixed_by(self, name: str, fixed: bool) -> dict[str, str]:
        """The `fixed_by` of a fixed parameter in the description, if any."""
        declared = self.model.actuator.parameters.get(name)
        return {"fixed_by": declared.fixed_by} if fixed and declared is not None and declared.fixed_by else {}

    def _static(self) -> dict[str, Any] | None:
        """D_c and D_pre of the settled angles, or of the fit where those are too few."""
        if self.static is not None:
            pair = {"D_c": self.static.coulomb_duty, "D_pre": self.static.preload_duty}
            return {name: {"value": x.value, "ci95": list(x.ci95)} for name, x in pair.items()}
        if self.lumps is None:
            return None
        return {
            name: {"value": duty.value, "ci95": list(duty.ci95) if duty.ci95 else None}
            for name, duty in fitted_duties(self.fitted).items()
        }


def identify(
    model: Model,
    recordings: Sequence[Recording],
    free: Sequence[str] = (),
    fixed: Sequence[str] = (),
    jobs: int | None = None,
) -> Identification:
    """Identify the actuator of `model` from `recordings`; `free` and `fixed` change what is fitted.

    `jobs` is the number of fits at a time, by default one for each core.
    """
    for recording in recordings:
        refuse_unmoved(recording, model.actuator)
    names = free_names(model, free, fixed)
    found, runaway = fitted(model, recordings, names, jobs)
    findings = identifiability(found, recordings)
    findings |= {name: endless(found, model, name, model.actuator.unit_of(name)) for name in runaway}
    static = static_characteristic(recordings, model.actuator) if papers(model.actuator) else None
    paper = papers(model.actuator) and found.model.values["spring_stiffness"] > 0.0
    return Identification(
        model,
        found,
        findings,
        fitted_lumps(found) if paper else None,
        static,
        _steps(recordings, found.model, static) if paper else None,
        validation_rmse(found.model.with_residual(model.residual_torque), recordings, found.names, jobs),
        float(np.sqrt(np.mean([noise_of(recording.time, recording.measured) ** 2 for recording in recordings]))),
    )


def papers(actuator: Actuator) -> bool:
    """Whether the paper's own procedure applies: a spring against a duty, and a measured angle."""
    return actuator.load == "spring" and actuator.drive == "voltage" and actuator.quantity != "speed"


def _steps(recordings: Sequence[Recording], model: Model, static: StaticCharacteristic | None) -> StepResponse | None:
    return step_response(recordings, model.actuator, static, model.values["supply_voltage"])


def free_names(model: Model, free: Sequence[str] = (), fixed: Sequence[str] = ()) -> tuple[str, ...]:
    """The parameters to fit: the actuator's free ones except HELD, those of effects that act, and `free`."""
    for name in (*free, *fixed):
        model.range(name)
    if both := [name for name in free if name in fixed]:
        raise InputError(f"Found {both[0]} in --free and in --fix, expected it in one of them. Leave one out.")
    base = [name for name in model.actuator.free if name not in HELD]
    effects = [
        f"{effect}.{parameter.name}"
        for effect in model.active_effects
        for parameter in EFFECT[effect].parameters
        if not parameter.choices and model.values[f"{effect}.{parameter.name}"] != 0.0
    ]
    names = tuple(name for name in dict.fromkeys([*base, *effects, *free]) if name not in fixed)
    if not names:
        raise InputError("Every parameter is fixed; expected one or more to fit. Leave out a --fix.")
    return names


def refuse_unmoved(recording: Recording, actuator: Actuator) -> None:
    """Raise InputError where the shaft does not move or the recording is too short to identify anything."""
    noise = noise_of(recording.time, recording.measured)
    middle, unit = np.percentile(recording.measured, [1.0, 99.0]), actuator.shown(recording.unit)
    if recording.time.size < 100 or middle[1] - middle[0] < 20.0 * noise or np.ptp(recording.measured) == 0.0:
        raise InputError(
            f"{recording.name} shows no motion to identify from ({recording.time.size} samples, "
            f"{middle[1] - middle[0]:.3g} {unit} of travel, noise {noise:.2g} {unit}). "
            "Record one of the recipes of 'pierburg experiment'."
        )


def validation_rmse(
    start: Model, recordings: Sequence[Recording], names: Sequence[str], jobs: int | None = None
) -> float:
    """RMSE on unseen data: on the last recording, or the end of the only one, after a fit to the rest."""
    if len(recordings) > 1:
        seen, unseen, first = recordings[:-1], recordings[-1], 0
    else:
        unseen = recordings[0]
        end = unseen.time[0] + TRAINED_SHARE * unseen.duration
        seen, first = [unseen.select(0.0, end)], int(np.searchsorted(unseen.time, end, side="right"))
    found, _ = fitted(start, seen, names, jobs)
    kept, simulated = resimulated(found.model, unseen)
    residual = (kept.measured - simulated)[first:]
    return float(np.sqrt(np.mean(residual**2)))


def _lump(lump: Lump) -> dict[str, Any]:
    return {"value": lump.value, "unit": lump.unit, "ci95": list(lump.ci95) if lump.ci95 else None}
