"""Whether a real recording can show what is put into it: apart from drift, and beside what remains there.

As for blind trials (`proof/visibility.py`), with what a machine leaves of its model in the place of what is simulated
beside the effect. No search is asked: only the recording as it is, its model, and the model with the change.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data, all_training, data_of, rms
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model
from pierburg_ros.proof.visibility import VISIBLE
from pierburg_ros.recording import Recording


@dataclass(frozen=True)
class Visibility:
    """How far a change stands out of what remains.

    `distance` is squared, from the nearest single drift, in standard deviations of what remains: the innovations of the
    likeliest discrepancy beside the noise. `moves` is what the change leaves in the signal once all that may drift is
    refitted, `remains` what the model without it misses then; root mean squares in the measured unit.
    """

    distance: float
    moves: float
    remains: float

    @property
    def shown(self) -> bool:
        """Whether the recording tells the change from a drift, and it moves the signal more than what else remains."""
        return self.distance >= VISIBLE and self.moves >= self.remains


def visibility(recording: Recording, model: Model, changed: Model, name: str) -> Visibility:
    """Judge what changes a `recording` of a machine like `model` as it changes that to `changed`, by the number `name`.

    Behind a filter of the input, whose time each recording tells anew, what comes late is not told from a shorter one.
    InputError where the recording cannot be used.
    """
    data = all_training(data_of([recording], model))
    target = replace(data, runs=tuple(replace(run, measured=run.simulated(changed)) for run in data.runs))
    drifts = tuple(each for each in drifting(model) if each != name)
    remains = scored(data, Estimator(data, model).at(Explanation())).discrepancy
    beside = Estimator(target, model, discrepancy=remains)
    nearest = min(beside.fit(Explanation((drift,)), iterations=BRIEF).chi2 for drift in drifts)
    effect = EFFECT.get(name.partition(".")[0])
    if effect and effect.late and data.input_filtered:
        nearest = 0.0
    return Visibility(nearest, _left(target, model, drifts), _left(data, model, drifts))


def _left(data: Data, model: Model, drifts: tuple[str, ...]) -> float:
    """What all that may drift leaves of measured signals, root mean square in the measured unit."""
    return rms(Estimator(data, model).fit(Explanation(drifts), iterations=BRIEF).solution.residual) * data.noise
