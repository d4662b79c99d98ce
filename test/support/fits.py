"""Fits that nobody has made: explanations with a given error, for what decides by errors alone."""

import numpy as np

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import Solution
from pierburg_ros.plant import Model

SAMPLES = 2000
WHITE = np.random.default_rng(11).standard_normal(SAMPLES)
WHITE /= np.sqrt(np.mean(WHITE**2))


def made_up(explanation: Explanation, ratio: float, model: Model, values: dict[str, float] | None = None) -> Fit:
    """A fit that leaves white noise of `ratio` times what was estimated on 2000 samples."""
    size = len(explanation.names)
    solution = Solution(np.zeros(size), ratio * WHITE, lambda: np.zeros((SAMPLES, size)))
    return Fit(explanation, {**model.values, **(values or {})}, model, None, solution, 0.0)


def of_chi2(explanation: Explanation, above: float, model: Model) -> Fit:
    """A fit whose chi2 is so much above the number of samples."""
    return made_up(explanation, float(np.sqrt(1.0 + above / SAMPLES)), model)


def found_among(data: Data, chosen: Fit, *others: Fit) -> Found:
    """A search of the nominal valve that has found these fits."""
    fits = {fit.explanation: fit for fit in (chosen, *others)}
    nominal = fits.setdefault(Explanation(), made_up(Explanation(), 5.0, chosen.model))
    return Found(data, nominal.model, drifting(nominal.model), fits, chosen, chosen, {}, nominal, False)
