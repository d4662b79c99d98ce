"""What a recording can show of what it conceals, computed from the truth alone.

The effect's signal is the noise-free Hall voltage with the effect less that without it. A diagnosis may
explain it by drift instead, so what counts is what remains after base parameters are refitted to it. Sum of
squares over noise variance is then the squared distance between both explanations in standard deviations:
no method sees less than a few.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from pierburg_ros.arrays import Signal
from pierburg_ros.proof.bench import Recorded
from pierburg_ros.proof.formulation import simulate_textbook
from pierburg_ros.proof.trial import Trial

COARSE_STEP = 5e-5  # s, for differences between two simulations of the same formulation
DRIFTING = (
    "armature_resistance",
    "torque_constant",
    "spring_stiffness",
    "spring_preload",
    "coulomb_friction",
    "supply_voltage",
)
LUMPS = ("armature_resistance", "supply_voltage", "spring_preload", "coulomb_friction")
"""These four reach every change of sliding motion's four lumps; the others repeat them."""
VISIBLE = 100.0
"""Squared distance [1] from which an effect counts as shown: ten standard deviations."""
REFITS = 60
"""Steps of a refit, at most: most end by themselves, those of four wrong numbers and an effect after up to 40."""
PERIODIC = ("phase",)


@dataclass(frozen=True)
class Visibility:
    """How much of the concealed effect a recording holds; distances are squared, in standard deviations."""

    noise: float  # V, of the measurement, converter included
    effect_rms: float  # V
    nominal_rmse: float  # V, of the noise-free voltage against the nominal valve
    recalibrated_rms: float  # V, left after all base parameters are refitted
    distance: float  # from the nearest explanation by no more quantities, all of them drift
    recalibrated_distance: float  # from the best explanation by drift of anything
    share_of_time: float  # smallest share of time that holds 80 % of the effect's energy
    bounds: dict[str, float]  # Cramer-Rao bound of each concealed parameter, deviation over value
    remainder_rms: float = 0.0  # V, what physics outside the catalogue beside the effect leaves after such a refit
    faint: tuple[str, ...] = ()  # of several effects, those that one drift can stand for beside the others

    @property
    def shown(self) -> bool:
        """Whether the recording tells the effect from drift, and it moves the signal more than what else remains."""
        return self.distance >= VISIBLE and self.recalibrated_rms >= self.remainder_rms

    def label(self) -> dict[str, Any]:
        """As it stands in the truth."""
        return {**asdict(self), "shown": self.shown}


def noise_floor(trial: Trial) -> float:
    """Standard deviation of the measured voltage about the ideal one [V]."""
    step = trial.effects.get("sensor_quantization.step", 0.0) or trial.converter_step
    return float(np.hypot(trial.noise, step / np.sqrt(12.0)))


def ideal(values: Mapping[str, float], run: Recorded) -> Signal:
    """Noise-free voltage [V] of a valve under the recorded duty, on the coarse step."""
    return simulate_textbook(values, run.time, run.duty, longest_step=COARSE_STEP)


def refitted(target: Signal, values: Mapping[str, float], names: Sequence[str], run: Recorded) -> Signal:
    """What is left of `target` [V] after the base parameters `names` are fitted to it by least squares."""

    def left(logs: Signal) -> Signal:
        fitted = {name: values[name] * float(np.exp(log)) for name, log in zip(names, logs, strict=True)}
        return ideal({**values, **fitted}, run) - target

    found = least_squares(left, np.zeros(len(names)), bounds=(-0.7, 0.7), diff_step=3e-3, max_nfev=REFITS)
    return np.asarray(found.fun)


def distance(left: Signal, noise: float) -> float:
    """Squared distance of a leftover from nothing [1]."""
    return float(np.sum(left**2) / noise**2)


def share_holding(signal: Signal, part: float = 0.8) -> float:
    """Smallest share of samples that holds `part` of the signal's energy [1]."""
    energy = np.sort(signal**2)[::-1].cumsum()
    return float((np.searchsorted(energy, part * energy[-1]) + 1) / signal.size) if energy[-1] > 0 else 0.0


def relative_bounds(trial: Trial, run: Recorded, noise: float) -> dict[str, float]:
    """Cramer-Rao bound of each concealed parameter [deviation over value], all that is concealed unknown."""
    unknown = [name for name, value in trial.effects.items() if value not in (0.0, 1e9)]
    columns = []
    for name in [*unknown, *trial.drifted]:
        width = 0.02 if name.endswith(PERIODIC) else 0.01 * abs(trial.values[name])
        ahead, behind = (ideal({**trial.values, name: trial.values[name] + s * width}, run) for s in (1, -1))
        columns.append((ahead - behind) / (2 * width) * (abs(trial.values[name]) or 1.0))
    jacobian = np.stack(columns, axis=1) / noise
    covariance = np.linalg.pinv(jacobian.T @ jacobian, rcond=1e-12)
    silent = np.linalg.norm(jacobian, axis=0) == 0.0
    spread = np.sqrt(np.diag(covariance))
    return {name: float(spread[k]) if not silent[k] else float("inf") for k, name in enumerate(unknown)}


def nearest_drift(full: Signal, trial: Trial, run: Recorded, noise: float) -> tuple[float, Signal]:
    """How far `full` [V] is from `trial` with one drift more [1], and what drift of anything leaves of it [V].

    Drift of anything comes closer than a single one, which need not be tried where that stays far away.
    """
    base = trial.values
    left = refitted(full, base, LUMPS, run)
    nearest = distance(left, noise)
    if nearest < VISIBLE:
        rivals = [[*trial.drifted, name] for name in DRIFTING if name not in trial.drifted]
        nearest = min(distance(refitted(full, base, names, run), noise) for names in rivals)
    return nearest, left


def faint(trial: Trial, full: Signal, run: Recorded, noise: float) -> tuple[str, ...]:
    """Which of several effects one drift more can stand for, the others known; `full` is the voltage with all [V]."""

    def rest(effect: str) -> Trial:
        others = {name: value for name, value in trial.effects.items() if not name.startswith(f"{effect}.")}
        return replace(trial, effects=others)

    return tuple(e for e in trial.effect_ids if nearest_drift(full, rest(e), run, noise)[0] < VISIBLE)


def visibility(trial: Trial, run: Recorded) -> Visibility:
    """Judge a recorded trial from its truth."""
    noise = noise_floor(trial)
    nominal_rmse = float(np.sqrt(np.mean((ideal({}, run) - run.ideal) ** 2)))
    if not trial.effects:
        return Visibility(noise, 0.0, nominal_rmse, 0.0, 0.0, 0.0, 0.0, {})
    full, bare = ideal(trial.values, run), ideal(trial.bare.values, run)
    clean = replace(trial, effects={}, remainder={})
    left = refitted(bare, clean.values, LUMPS, run) if trial.remainder else np.zeros(1)
    nearest, recalibrated = nearest_drift(full, trial.bare, run, noise)
    return Visibility(
        noise=noise,
        effect_rms=float(np.sqrt(np.mean((full - bare) ** 2))),
        nominal_rmse=nominal_rmse,
        recalibrated_rms=float(np.sqrt(np.mean(recalibrated**2))),
        distance=nearest,
        recalibrated_distance=distance(recalibrated, noise),
        remainder_rms=float(np.sqrt(np.mean(left**2))),
        share_of_time=share_holding(full - bare),
        bounds=relative_bounds(trial, run, noise),
        faint=faint(trial, full, run, noise) if len(trial.effect_ids) > 1 else (),
    )
