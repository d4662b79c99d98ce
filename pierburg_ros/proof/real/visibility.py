"""Whether a real recording can show what is put into it: apart from drift, and beside what remains there.

As for blind trials (`proof/visibility.py`), with what a machine leaves of its model in the place of what is simulated
beside the effect. No search is asked: only the recording as it is, its model, and the model with the change.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from pierburg_ros.inference.balance import balance_of
from pierburg_ros.inference.data import all_fitted
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fitter, pull_of, rms_of, strongest
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.inference.replay import parts_of
from pierburg_ros.inference.search import free_parameters
from pierburg_ros.inference.shortlist import independent
from pierburg_ros.plant import Model
from pierburg_ros.proof.visibility import VISIBLE
from pierburg_ros.recording import Recording


@dataclass(frozen=True)
class Visibility:
    """How far a change stands out of what remains.

    `distance` is squared, from the nearest single drift, in standard deviations of what remains, in effective samples
    of that. `moves` is what the change leaves in the signal once all that may drift is
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

    InputError where the recording cannot be used.
    """
    data = all_fitted(parts_of(recording, model.actuator), model)
    fitter = Fitter(data, model, pull_of(model.actuator, data.period))
    lefts = data.by_run(fitter.residual(changed) * data.noise)
    runs = [replace(run, measured=run.measured - left) for run, left in zip(data.runs, lefts, strict=True)]
    put_in = replace(fitter, data=replace(data, runs=tuple(runs)))
    drifts = tuple(each for each in free_parameters(model) if each != name)
    nearest = min(put_in.fit(Explanation((drift,)), model.values, BRIEF).chi2 for drift in drifts)
    remains = fitter.fit(Explanation(), model.values, 0)
    first = strongest(fitter)
    told = independent(first, balance_of(data, model, first.constant), drifts)
    distance = nearest / max(remains.ratio**2 * remains.repetition, 1.0)
    return Visibility(distance, _left(put_in, told), _left(fitter, told))


def _left(fitter: Fitter, drifts: Sequence[str]) -> float:
    """What all that may drift leaves of measured signals, root mean square in the measured unit."""
    found = fitter.fit(Explanation(tuple(drifts)), fitter.nominal.values, BRIEF)
    return rms_of(found, fitter.data.train)
