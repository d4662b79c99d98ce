"""The share of the mismatch that each named effect explains, alone and beside the others, and the share that
remains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import counted
from pierburg_ros.inference.explanation import Variant, without
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

SEEN = 0.02
"""Squared error above the noise, as a share of the squared noise, below which there is no mismatch. Derived: the noise
is known to about a hundredth (standard deviation 0.008, n = 300 white recordings), its square to twice that."""


@dataclass(frozen=True)
class Share:
    """Shares of the mismatch, 0 to 1, that an effect explains `beside` the others, and `alone`."""

    beside: float
    alone: float


@dataclass(frozen=True)
class Shares:
    """The share of each named effect by id, and the share that `remains`; None where there is no mismatch.

    The mismatch is the squared error above the noise on the training samples, of the nominal model with its parameters
    re-estimated.
    """

    effects: dict[str, Share]
    remains: float | None


def shares(found: Found, conclusion: Conclusion, jobs: int | None = None, deadline: Deadline | None = None) -> Shares:
    """The shares that the effects of a conclusion explain, and that its model (with any residual torque) leaves.

    Beside the others: what is lost if an effect is left out and the rest is fitted again. Alone: what is gained if it
    is added to the model with re-estimated parameters, without the others.
    """
    recalibrated, final = conclusion.recalibrated, conclusion.final
    with workers(jobs, deadline) as pool:
        estimator = Estimator(found.data, found.nominal, pool.map)
        before = _excess(estimator, recalibrated.model, recalibrated)
        if before <= SEEN:
            return Shares({}, None)
        left = _excess(estimator, final.model, final)
        effects = {}
        for variant in final.explanation.variants:
            if EFFECT[variant.effect].rounds is not None:
                continue
            lost = _excess_without(estimator, final, variant) - left
            gained = before - _excess_alone(estimator, recalibrated, final, variant)
            effects[variant.effect] = Share(*(float(np.clip(part / before, 0.0, 1.0)) for part in (lost, gained)))
        return Shares(effects, float(np.clip(_excess(estimator, conclusion.model, final) / before, 0.0, 1.0)))


def _excess(estimator: Estimator, model: Model, fit: Fit) -> float:
    """Mean squared error [noise^2] above the noise on the training samples."""
    residual = estimator.residual(model, fit.switch)
    return max(counted(residual, estimator.data.half_step) / residual.size - 1.0, 0.0)


def _excess_without(estimator: Estimator, final: Fit, variant: Variant) -> float:
    bare = estimator.fit(without(final.explanation, variant), final.values)
    return max(bare.ratio**2 - 1.0, 0.0)


def _excess_alone(estimator: Estimator, recalibrated: Fit, final: Fit, variant: Variant) -> float:
    explanation = recalibrated.explanation.plus(variant)
    own = {name: value for name, value in final.values.items() if name.startswith(f"{variant.effect}.")}
    starts = ({**recalibrated.values, **own}, {**final.values, **own})
    fits = (estimator.fit(explanation, start) for start in starts)
    return max(min(fit.ratio for fit in fits) ** 2 - 1.0, 0.0)
