"""The four numbers of a spring-loaded actuator that sliding motion shows, and their intervals from a fit.

time_constant w = gain duty - angle - preload_angle - friction_angle sign(w), equations (5) and (6) of the paper without
inductance and inertia. Duty and angle alone determine nothing else between the stops.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.identification.fit import Identified
from pierburg_ros.inference.covariance import RANK
from pierburg_ros.plant import Model
from pierburg_ros.plant.braking import braking

UNITS = {"time_constant": "s", "gain": "rad", "preload_angle": "rad", "friction_angle": "rad"}
DUTY_UNITS = {"D_c": "1", "D_pre": "1"}


@dataclass(frozen=True)
class Lump:
    """A derived value with its 95 % interval; the interval is None where the recording does not determine it."""

    value: float
    unit: str
    ci95: tuple[float, float] | None


def lumps(model: Model) -> dict[str, float]:
    """Time constant [s], gain, preload angle and friction angle [rad] of a spring-loaded model."""
    value = model.values
    stiffness, resistance = value["spring_stiffness"], value["armature_resistance"]
    constant = value["gear_ratio"] * value["torque_constant"]
    return {
        "time_constant": braking(model) / stiffness,
        "gain": constant * value["supply_voltage"] / (resistance * stiffness),
        "preload_angle": value["spring_preload"] / stiffness,
        "friction_angle": value["coulomb_friction"] / stiffness,
    }


def duties(model: Model) -> dict[str, float]:
    """Duties that overcome friction, D_c, and preload, D_pre, by equation (9) [1]."""
    lump = lumps(model)
    return {
        "D_c": lump["friction_angle"] / lump["gain"],
        "D_pre": lump["preload_angle"] / lump["gain"],
    }


def fitted_lumps(fitted: Identified) -> dict[str, Lump]:
    """The lumps of a fit; they are known even where the parameters behind them are tied."""
    return _derived(fitted, lumps, UNITS)


def fitted_duties(fitted: Identified) -> dict[str, Lump]:
    """D_c and D_pre of a fit."""
    return _derived(fitted, duties, DUTY_UNITS)


def _derived(
    fitted: Identified, quantities: Callable[[Model], dict[str, float]], units: dict[str, str]
) -> dict[str, Lump]:
    """Positive `quantities` of the fitted model; their intervals come from the slopes of their logarithms."""
    values, slopes = quantities(fitted.model), _relative_slopes(fitted, quantities)
    _, lengths, directions = np.linalg.svd(fitted.slopes, full_matrices=False)
    unknown = directions[lengths <= RANK * lengths[0]]
    fixed = np.linalg.norm(slopes @ unknown.T, axis=1) < 1e-3
    variances = np.einsum("ij,jk,ik->i", slopes, fitted.covariance.matrix, slopes)
    widths = np.exp(fitted.covariance.factor * np.sqrt(variances))
    return {
        name: Lump(value, units[name], (float(value / width), float(value * width)) if known else None)
        for (name, value), width, known in zip(values.items(), widths, fixed, strict=True)
    }


def _relative_slopes(fitted: Identified, quantities: Callable[[Model], dict[str, float]]) -> Signal:
    """Derivative of the logarithm of each quantity by the coordinates, shape (quantities, names)."""
    step, fitter, explanation = 1e-6, fitted.fitter, fitted.fit.explanation
    coordinates = fitter.coordinates(explanation)

    def logarithms(point: Signal) -> Signal:
        model, *_ = fitter.models(explanation, {**fitter.nominal.values, **coordinates.values(point)})
        with np.errstate(divide="ignore", invalid="ignore"):  # nothing is known of a lump that is 0
            return np.log(list(quantities(model).values()))

    point = fitted.fit.solution.point
    moves = step * np.eye(point.size)
    return np.stack([(logarithms(point + move) - logarithms(point - move)) / (2.0 * step) for move in moves], axis=1)
