"""A linear step tells what an addition promises, and a pair that promises much is fitted before all others."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from pierburg_ros.diagnosis.evidence.data import EvidenceData, evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.explore import FINISHED, Exploration
from pierburg_ros.diagnosis.search.fits import Search
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.screening import Outlook, Prospect, most_promising

pytestmark = pytest.mark.search

LAG = Variant("sensor_lag", ("time_constant",))


def evidence(changes: dict[str, float]) -> EvidenceData:
    return evidence_of([recording(changes)], PIERBURG)


def prospects_on(data: EvidenceData, explanation: Explanation) -> list[Prospect]:
    search = Search(data, NOMINAL)
    outlook = Outlook(search, search, drifting(NOMINAL), lambda _: None)
    with ThreadPoolExecutor(2) as pool:
        return outlook.on(search.fit(explanation), {}, pool)


@pytest.mark.parametrize("seed", [Explanation(("spring_preload",)), Explanation((), (LAG,))])
def test_what_is_missing_beside_a_part_of_the_truth_promises_most(seed: Explanation) -> None:
    prospects = prospects_on(evidence({"sensor_lag.time_constant": 0.01, "spring_preload": 0.295}), seed)
    (best,) = most_promising(prospects, 1)
    assert best.explanation == Explanation(("spring_preload",), (LAG,))
    assert 0.95 < best.promise < 0.5 * best.base.ratio


def test_a_pair_that_accounts_for_all_is_found_before_others_are_grown() -> None:
    data = evidence({"sensor_lag.time_constant": 0.012, "spring_preload": 0.32})
    exploration = Exploration(data, NOMINAL)
    assert exploration.run().explanation == Explanation(("spring_preload",), (LAG,))
    assert len(exploration.of_size(2)) <= FINISHED
