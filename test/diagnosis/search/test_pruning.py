"""What wins is held against smaller explanations and other drifts, fitted from its own values."""

from concurrent.futures import Executor

import pytest
from support.fits import made_up
from support.grown import NOTHING, ONES, PAIRS, Grown
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation

THREE = Explanation((), tuple(variant for one in (ONES[3], ONES[2], ONES[0]) for variant in one.variants))
"""Play, where events jump, a dead band and a lag."""

SWAPPED = Explanation(("spring_preload",), THREE.variants[:2])


def test_a_drift_gets_its_chance_in_the_place_of_one_of_two_effects(short: Data, pool: Executor) -> None:
    """From where the two have ended: an effect of which little is seen stands for a drift that stopped before that."""
    two = Explanation((), tuple(sorted((*ONES[0].variants, *ONES[1].variants), key=lambda each: each.effect)))
    with_drift = Explanation(("coulomb_friction",), two.variants[:1])

    class Stopped(Grown):
        def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
            late = explanation == with_drift and two not in self.fits
            return self.keep(made_up(explanation, 5.0 if late else self.ratios.get(explanation, 9.0), NOMINAL))

    found = Stopped(short, pool, {NOTHING: 9.0, ONES[0]: 6.0, with_drift: 1.0, two: 1.005}, Beam(depth=2))
    assert found.run().explanation == with_drift


@pytest.mark.parametrize("ways", [{THREE: PAIRS[3]}, {THREE: SWAPPED, SWAPPED: PAIRS[3]}], ids=["at once", "in turn"])
def test_a_drift_and_an_effect_get_their_chance_from_the_values_of_three(
    short: Data, pool: Executor, ways: dict[Explanation, Explanation]
) -> None:
    """Each explanation comes to the noise from the end of another alone, told by a value; three effects have."""
    ends = {explanation: 0.2 + 0.01 * place for place, explanation in enumerate([*ways, PAIRS[3]], 1)}
    starts = {to: ends[larger] for larger, to in ways.items()}

    class Stopped(Grown):
        def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
            led = start is not None and starts.get(explanation) == start["coulomb_friction"]
            end = {"coulomb_friction": ends[explanation]} if led else {}
            return self.keep(made_up(explanation, 1.0 if led else 9.0, NOMINAL, end))

    found = Stopped(short, pool, {}, Beam())
    found.add(NOTHING)
    found.keep(made_up(THREE, 1.0, NOMINAL, {"coulomb_friction": ends[THREE]}))
    assert pruned(found).explanation == PAIRS[3]
