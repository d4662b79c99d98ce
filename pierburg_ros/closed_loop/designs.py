"""The controllers that are tuned and compared: the PIFLC of the paper, a plain PI and a PID."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.control import Settings, law, linear

NO_DERIVATIVE = {"derivative_support": 1e9, "derivative_time_constant": 0.0}


@dataclass(frozen=True)
class Design:
    """A structure of controller, and between which bounds which of its settings are tuned.

    The proportional gain stays 1: only its ratios to the other gains and to the support matter.
    """

    name: str
    control: ModuleType
    tuned: dict[str, tuple[float, float]]
    fixed: dict[str, float]

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Bounds of the search, which runs over the logarithms of the settings."""
        return [(float(np.log(low)), float(np.log(high))) for low, high in self.tuned.values()]

    def settings(self, point: NDArray[np.float64]) -> Settings:
        """The settings at a point of the search, to three digits."""
        found: dict[str, Any] = {
            name: float(f"{value:.3g}") for name, value in zip(self.tuned, np.exp(point), strict=True)
        }
        if "negative" in found:
            found["negative"] *= -1.0
        return Settings(proportional_gain=1.0, **self.fixed, **found)


PI = {
    "integral_gain": (0.1, 100.0),
    "integral_dead_zone": (0.0005, 0.015),
    "pi_output_support": (0.06, 2.0),
}
DERIVATIVE = {"derivative_support": (60.0, 10000.0), "derivative_time_constant": (0.0001, 0.01)}
SCHEDULE = {"load_share": (0.05, 1.5)}
"""Above 1 a schedule of the model as it is also carries the load with its winding hot."""
SETS = {"positive": (0.4, 0.99), "negative": (0.4, 0.99)}  # the latter without its sign

DESIGNS = {
    design.name: design
    for design in (
        Design("PIFLC", law, PI | DERIVATIVE | SETS, {}),
        Design("PI", linear, PI, NO_DERIVATIVE),
        Design("PID", linear, PI | DERIVATIVE, {}),
    )
}
