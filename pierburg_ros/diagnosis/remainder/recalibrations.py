"""Ways to calibrate a model that lacks physics: its parameters adapt to the missing physics, in each way
differently."""

from __future__ import annotations

from pierburg_ros.diagnosis.evidence.stretches import in_stretches
from pierburg_ros.diagnosis.remainder.shape import STRETCH, Way
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import Model


def recalibrations(nominal: Model, explanation: Explanation) -> list[Way]:
    """`nominal` as it is, and with the parameters of `explanation` fitted in three ways.

    They are fitted to whole runs, to stretches of them, and to stretches with large errors counting by their logarithm.
    """

    def described(_: Data) -> Model:
        return nominal

    def whole(data: Data) -> Model:
        return Estimator(data, nominal).fit(explanation).model

    def stretches(data: Data) -> Model:
        return Estimator(in_stretches(data, STRETCH * data.scales.time), nominal).fit(explanation).model

    def forgiving(data: Data) -> Model:
        return Estimator(in_stretches(data, STRETCH * data.scales.time), nominal).fit(explanation, forgiving=True).model

    return [described, whole, stretches, forgiving]
