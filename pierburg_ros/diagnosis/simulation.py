"""The user's own simulator in place of the description: what it does is nominal, and never missing physics.

The parameters of the description are fitted to recordings that the simulator made, with effects where its equations
need them. The error that is left is the difference between the two simulators. It is kept apart: it counts as noise,
and the chi2 that it could give is no evidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.schema import Diagnosis, Simulated, Simulation
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.inference.choice import Choice
from pierburg_ros.inference.evidence import rms
from pierburg_ros.inference.fit import Fit
from pierburg_ros.inference.infer import infer
from pierburg_ros.inference.search import Progress
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import encoded
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of


@dataclass(frozen=True)
class Reproduction:
    """A simulator as our equations reproduce it.

    `model` is nominal for an actuator whose nominal numbers are the simulator's; `described` is the model of the
    description. `left` is the root mean square of the error of the fit to the simulator's recordings, without their own
    noise. `described_rmse` is that of the description as it is, their noise included. Both are in the measured unit.
    """

    recordings: tuple[str, ...]
    described: Model
    model: Model
    described_rmse: float
    left: float
    travel: float

    def told(self, result: Result) -> Result:
        """A diagnosis against `model` that says so, with its model in the terms of the description."""
        found = result.diagnosis
        summary = f"{self.sentence(found.unit)} {found.summary}"
        written = found.model_copy(update={"simulation": self.document(found), "summary": summary})
        model = Model(self.described.actuator, result.model.values, result.model.residual_torque)
        return replace(result, diagnosis=written, model=model)

    def sentence(self, unit: str) -> str:
        """What the recordings are compared with, and how well our equations reproduce it."""
        count = len(self.recordings)
        own = f"{count} recordings of it" if count > 1 else "a recording of it"
        needed = f", with {_listed(self.model.active_effects)}" if self.model.active_effects else ""
        return (
            f"Held against your simulator, not against the description: our equations reproduce {own} to "
            f"{self.left:.2g} {unit}, {100.0 * self.left / self.travel:.2g} % of its travel{needed} (as described: "
            f"{self.described_rmse:.2g} {unit}). What they leave is kept apart and counts as no evidence."
        )

    def document(self, found: Diagnosis) -> Simulation:
        """The same for diagnosis.json."""
        names = {name: each.unit for name, each in found.parameters.items()}
        before, after = self.described.values, self.model.values
        return Simulation(
            recordings=list(self.recordings),
            described_rmse=self.described_rmse,
            rmse=self.left,
            parameters={
                name: Simulated(described=before[name], value=after[name], unit=unit) for name, unit in names.items()
            },
            effects={
                effect: {name: after[f"{effect}.{name}"] for name in EFFECT[effect].names}
                for effect in self.model.active_effects
            },
        )


def reproduction(
    simulation: Sequence[Recording],
    real: Sequence[Recording],
    described: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
) -> Reproduction:
    """The simulator that made the recordings `simulation`, fitted as finely as the `real` ones can show.

    InputError if they cannot be used.
    """
    recordings = [as_measured(recording, described) for recording in simulation]
    progress("your simulator")
    noise = float(np.median([noise_of(each.time, each.measured) for each in real]))

    def tell(what: str) -> None:
        progress(f"your simulator: {what}")

    choice = infer(recordings, described, tell, jobs, unlike=noise).choice
    fit = lasting(choice)
    actuator, data = with_nominal(described.actuator, fit), fit.fitter.data
    rmse, before = (rms(each.residual) * data.noise for each in (fit, choice.described))
    travel = max(float(np.ptp(run.measured)) for run in data.runs)
    left = float(np.sqrt(max(rmse**2 - data.noise**2, 0.0)))
    names = tuple(dict.fromkeys(recording.name for recording in recordings))
    return Reproduction(names, described, Model.nominal(actuator), before, left, travel)


def as_measured(recording: Recording, described: Model) -> Recording:
    """A simulator's recording in the quantity that the actuator measures: an angle as a correct sensor shows it."""
    wanted = described.actuator.quantity
    if recording.quantity == wanted:
        return recording
    if (recording.quantity, wanted) == ("position", "hall_voltage"):
        return replace(recording, quantity=wanted, measured=encoded(described, recording.measured))
    raise InputError(
        f"{recording.name}, given as simulation, holds {recording.quantity}, but actuator {described.actuator.name} "
        f"measures {wanted}. Record {wanted} in your simulator."
    )


def lasting(choice: Choice) -> Fit:
    """The model that predicts best or, if it depends on a time in one recording, the best one that does not."""
    able = [fit for fit in (choice.predictor, *choice.fits) if _lasts(fit)]
    return able[0] if able[0] is choice.predictor else min(able, key=lambda fit: fit.chi2)


def _lasts(fit: Fit) -> bool:
    """Whether an explanation holds at any time in any recording."""
    return fit.explanation.changed is None and not any(EFFECT[name].dated for name in fit.explanation.effects)


def with_nominal(actuator: Actuator, fit: Fit) -> Actuator:
    """`actuator` with a fit's values as its nominal ones, and the fit's effects as those that it always has."""
    values = fit.model.values
    parameters = {name: replace(each, default=values[name]) for name, each in actuator.parameters.items()}
    effects = {name: {p: values[f"{name}.{p}"] for p in EFFECT[name].names} for name in fit.model.active_effects}
    return replace(actuator, parameters=parameters, effects=effects)


def _listed(names: Sequence[str]) -> str:
    """Names of effects in words."""
    return " and ".join(name.replace("_", " ") for name in names)
