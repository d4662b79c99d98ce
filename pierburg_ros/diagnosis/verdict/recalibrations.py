"""Ways to calibrate a model that lacks physics: what it lacks bends its parameters, each way otherwise."""

from __future__ import annotations

from pierburg_ros.diagnosis.evidence.data import EvidenceData
from pierburg_ros.diagnosis.evidence.stretches import restarted
from pierburg_ros.diagnosis.search.explanation import Explanation
from pierburg_ros.diagnosis.search.fits import Search
from pierburg_ros.diagnosis.verdict.residual_shape import STRETCH, Way
from pierburg_ros.plant import Model


def recalibrations(nominal: Model, explanation: Explanation) -> list[Way]:
    """`nominal` as it is; with the parameters of `explanation` fitted to whole runs; to stretches of them; the same
    with large errors counting by their logarithm."""

    def described(_: EvidenceData) -> Model:
        return nominal

    def whole(data: EvidenceData) -> Model:
        return Search(data, nominal).fit(explanation).model

    def stretches(data: EvidenceData) -> Model:
        return Search(restarted(data, STRETCH), nominal).fit(explanation).model

    def forgiving(data: EvidenceData) -> Model:
        return Search(restarted(data, STRETCH), nominal).fit(explanation, forgiving=True).model

    return [described, whole, stretches, forgiving]
