"""What one blind trial hides, and the label that is sealed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from pierburg_ros.proof.formulation import NOMINAL

UNITS = {
    "coefficient": {"viscous_friction": "N.m.s/rad"},
    "quadratic": {"": "N.m.s^2/rad^2"},
    "cubic": {"": "N.m.s^3/rad^3"},
    "stiffness": {"": "N.m/rad"},
    "damping": {"": "N.m.s/rad"},
    "breakaway_torque": {"": "N.m"},
    "stribeck_velocity": {"": "rad/s"},
    "viscous_difference": {"": "N.m.s/rad"},
    "coulomb_difference": {"": "N.m"},
    "amplitude": {"": "N.m", "sensor_nonlinearity": "1"},
    "center": {"": "rad"},
    "width": {"": "rad", "pwm_deadband": "1"},
    "gap": {"": "rad"},
    "phase": {"": "rad"},
    "cubic_stiffness": {"": "N.m/rad^3"},
    "knee_stiffness": {"": "N.m/rad"},
    "knee_angle": {"": "rad"},
    "torque": {"": "N.m"},
    "frequency": {"": "Hz"},
    "start": {"": "s"},
    "end": {"": "s"},
    "thermal_resistance": {"": "K/W"},
    "heat_capacity": {"": "J/K"},
    "source_resistance": {"": "ohm"},
    "inductance": {"": "H"},
    "delay": {"": "s"},
    "time_constant": {"": "s"},
    "step": {"": "V"},
    "yield_torque": {"": "N.m"},
    "exposure": {"": "rad.s"},
    "growth": {"": "1"},
}


def unit(effect: str, parameter: str) -> str:
    """Unit of an effect's parameter, as section 7 of docs/contract.md writes it."""
    by_effect = UNITS.get(parameter, {})
    return by_effect.get(effect, by_effect.get("", "1"))


@dataclass(frozen=True)
class Change:
    """A base parameter that jumps from one sample to the next in the middle of the recording."""

    parameter: str
    time: float  # s
    before: float
    after: float


@dataclass(frozen=True)
class Trial:
    """Everything that makes a trial repeatable: what is concealed, and how it is recorded."""

    name: str
    kind: str  # one of KINDS in concealment.py, or of dirt
    seed: int
    effects: Mapping[str, float]  # flat dotted names of the concealed physics, in the catalogue or outside it
    drifted: Mapping[str, float]
    change: Change | None
    closed_loop: bool
    remainder: Mapping[str, float] = field(default_factory=dict)  # physics outside the catalogue, beside the effects
    controller: Mapping[str, float] = field(default_factory=dict)
    noise: float = 0.002  # V
    converter_step: float = 5.0 / 4096.0  # V, resolution of the logger, not of the valve's own sensor
    rate: float = 500.0  # Hz
    duration: float = 60.0  # s
    holdout_duration: float = 40.0  # s
    over_graph: bool = False  # recorded by the three nodes instead of in this process
    dirt: str = ""  # what disturbs the valve or spoils the log of the recording that is diagnosed

    @property
    def values(self) -> dict[str, float]:
        """Flat values of the concealed plant at the start."""
        base = {**NOMINAL, **self.drifted}
        if self.change is not None:
            base[self.change.parameter] = self.change.before
        return {**base, **self.remainder, **self.effects}

    @property
    def effect_ids(self) -> tuple[str, ...]:
        """Names of the concealed physics, in the catalogue or not."""
        return tuple(sorted({name.partition(".")[0] for name in self.effects}))

    @property
    def bare(self) -> Trial:
        """The same trial without its concealed effects; drift stays."""
        return replace(self, effects={})

    @property
    def verdict(self) -> str:
        """The verdict that is right where the recording shows what is hidden."""
        if self.kind == "outside" or self.remainder:
            return "unexplained"
        if self.effects:
            return "missing_physics"
        return "parameter_drift" if self.drifted or self.change else "consistent"


def truth(trial: Trial) -> dict[str, Any]:
    """The label of a trial, in the form of the practice recordings."""
    outside = trial.kind == "outside"
    change = trial.change
    return {
        "id": trial.name,
        "kind": trial.kind,
        "seed": trial.seed,
        "severity": "concealed" if trial.closed_loop else "plain",
        "verdict": trial.verdict,
        "effects": [] if outside else _labelled(trial),
        "drifted": dict(trial.drifted),
        "remainder": dict(trial.remainder),
        "changes": [vars(change)] if change else [],
        "not_in_catalogue": trial.effect_ids[0] if outside else None,
        "outside_parameters": _labelled(trial)[0]["parameters"] if outside else {},
        "noise_volts": trial.noise,
        "converter_step_volts": trial.converter_step,
        "rate": trial.rate,
        "over_graph": trial.over_graph,
        "dirt": trial.dirt,
    }


def _labelled(trial: Trial) -> list[dict[str, Any]]:
    """Concealed effects with their parameters and units."""
    effects = []
    for effect in trial.effect_ids:
        parameters = {
            name.partition(".")[2]: {"value": value, "unit": unit(effect, name.partition(".")[2])}
            for name, value in trial.effects.items()
            if name.startswith(f"{effect}.")
        }
        effects.append({"id": effect, "parameters": parameters})
    return effects


def concealed_values(label: Mapping[str, Any]) -> tuple[dict[str, float], dict[str, float]]:
    """Flat values of what a label says was concealed, and of what is there beside it at the start."""
    outside = label["not_in_catalogue"]
    concealed = [{"id": outside, "parameters": label["outside_parameters"]}] if outside else label["effects"]
    effects = {
        f"{effect['id']}.{name}": float(given["value"])
        for effect in concealed
        for name, given in effect["parameters"].items()
    }
    return effects, {**label["drifted"], **label.get("remainder", {})}
