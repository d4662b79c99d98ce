"""A search that fits nothing, to test in which order one goes on; and the explanations it is given."""

from collections.abc import Sequence
from concurrent.futures import Executor

from support.fits import made_up
from support.recordings import NOMINAL

from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Explanation, Variant

LAG = Variant("sensor_lag", ("time_constant",))
VISCOUS = Variant("viscous_friction", ("coefficient",))
NOTHING = Explanation()
ONES = [
    Explanation((), (Variant(effect, ("x",)),)) for effect in ("sensor_lag", "supply_sag", "pwm_deadband", "backlash")
]
PAIRS = [Explanation(("spring_preload",), one.variants) for one in ONES]
FRICTION = Explanation(("coulomb_friction",))


class Grown(Search):
    """A search that fits nothing: it keeps from which explanations it was asked to grow."""

    def __init__(self, data: Data, pool: Executor, ratios: dict[Explanation, float], beam: Beam) -> None:
        super().__init__(data, NOMINAL, pool, beam=beam)
        self.ratios = ratios
        self.seeds: list[Explanation] = []
        self.before_ripples: dict[int, list[Explanation]] = {}

    def add(self, explanation: Explanation, start: dict[str, float] | None = None) -> Fit:
        return self.keep(made_up(explanation, self.ratios.get(explanation, 9.0), NOMINAL))

    def expand(self, seed: Fit) -> list[Fit]:
        if seed.explanation in self.expanded:
            return []
        self.expanded.add(seed.explanation)
        self.seeds.append(seed.explanation)
        self.tried += 1
        larger = (e for e in self.ratios if e.size == seed.explanation.size + 1)
        return [self.add(explanation) for explanation in larger]

    def refine(self, fits: object) -> None:
        pass

    def refine_alone(self, fit: object) -> None:
        pass

    def fit_most_promising(self, seeds: object) -> None:
        pass

    def _fit_ripples(self, seeds: Sequence[Fit]) -> None:
        self.before_ripples.setdefault(seeds[0].explanation.size + 1, [*self.seeds])

    def _exchange_drift(self, fit: Fit) -> None:
        pass

    def _all_drift(self) -> bool:
        return False

    def _likeliest_accounts_for_all(self) -> bool:
        self.resigned = self.beam.resigns
        return False
