"""diagnosis.json, schema 3 (section 5 of docs/contract.md): every field with its unit; null where there is none."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

Verdict = Literal["consistent", "parameter_drift", "missing_physics", "unexplained"]
Status = Literal["chosen", "rejected", "tied", "not_testable"]


def _existing(value: Any) -> Any:
    """`value`, or None where it is not a finite number."""
    return value if value is None or math.isfinite(value) else None


def _existing_interval(value: Any) -> Any:
    """Both ends of an interval, or None where one of them is not a finite number."""
    if value is None or any(_existing(end) is None for end in value):
        return None
    return tuple(float(end) for end in value)


Number = Annotated[float | None, BeforeValidator(_existing)]
Interval = Annotated[tuple[float, float] | None, BeforeValidator(_existing_interval)]
Tie = list[str]
Over = Literal["constant", "velocity", "angle", "load", "time", "rest", "reversal"]
"""What a missing torque may go with."""
Direction = Literal["both", "positive", "negative"]
"""Of the shaft: to larger angles, to smaller ones, or both."""


class Part(BaseModel):
    """A part of the document: read-only, no fields but its own, no number that JSON lacks."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True, populate_by_name=True
    )


class Estimate(Part):
    """One number of an effect."""

    value: Number
    """In `unit`."""
    unit: str
    ci95: Interval
    """95 % confidence interval, in `unit`."""
    identifiable: bool
    """Whether these recordings determine the value."""
    at_bound: bool = False
    """Whether the value is where a search ends: the true one may lie beyond."""
    tied_with: list[str] = []
    """Other quantities of the same model that may move with it, so that the recordings stay as they are."""


class Effect(Part):
    """A catalogue effect that the recordings need."""

    id: str
    """Name in the catalogue."""
    confidence: Number
    """0 to 1: how sure the effect is, against the explanations that were tried."""
    parameters: dict[str, Estimate]
    """By name in the catalogue."""
    indistinguishable_from: list[Tie] = []
    """Alternatives that fit as well, each a list of effect ids and parameter names."""
    share: Number = None
    """Of the mismatch of the model as described, what it explains beside the others, 0 to 1; null without mismatch."""
    share_alone: Number = None
    """Of the mismatch of the model as described, what it explains without the other effects, 0 to 1."""
    explanation: str
    """Why, in words, with numbers."""


class Doubted(Part):
    """An effect that gains something, but is not probable enough to be named, or not needed beside what is."""

    id: str
    """Name in the catalogue."""
    confidence: Number
    """0 to 1: how probable the effect is by itself."""
    share: Number = None
    """Of the mismatch of the model as described, what it explains beside re-estimated parameters, 0 to 1."""
    parameters: dict[str, Estimate] = {}
    """Its values there, by name in the catalogue."""
    explanation: str
    """Why, in words, with numbers."""


class BaseParameter(Part):
    """A parameter that every model of the actuator has."""

    nominal: Number
    """As the actuator is described, in `unit`."""
    value: Number
    """As the chosen explanation has it, in `unit`."""
    unit: str
    ci95: Interval
    """95 % confidence interval, in `unit`."""
    identifiable: bool
    """Whether these recordings determine the value."""
    drifted: bool
    """Whether the chosen explanation changes it."""
    indistinguishable_from: list[Tie] = []
    """Alternatives that fit as well, each a list of effect ids and parameter names."""
    tied_with: list[str] = []
    """Other parameters of the same model that may move with it, so that the recordings stay as they are."""
    held: str | None = None
    """Why it was not fitted, in words; null where it was."""
    at_bound: bool = False
    """Whether the value is where a search ends: the true one may lie beyond."""


class Change(Part):
    """A parameter that changed in the middle of a recording."""

    parameter: str
    time: float
    """Moment of the change [s], from the first sample: the likeliest in `time_ci95`, where that is known."""
    time_ci95: Interval = None
    """Its 95 % confidence interval [s]: as long as the shaft stands still, a change may come at any moment."""
    before: float
    """In the unit of the parameter."""
    after: float
    """In the unit of the parameter."""


class Location(Part):
    """A window of the first recording that holds much of the mismatch."""

    start: float
    """From the first sample [s]."""
    end: float
    """From the first sample [s]."""
    share: float
    """Of the residual energy of the recalibrated nominal model, 0 to 1."""
    regime: str
    """What the shaft does there."""
    direction: Direction = "both"
    """In which direction the shaft moves there."""


class Regime(Part):
    """A range of a variable in which the mismatch gathers."""

    variable: str
    range: tuple[float, float]
    """Lowest and highest value, in `unit`."""
    unit: str
    share_of_residual: float
    """Of the residual energy of the recalibrated nominal model, 0 to 1."""
    share_of_time: float
    """Of the recording, 0 to 1."""
    chance: Number = None
    """How often blocks of the residual in random order gather as much anywhere along the variable, 0 to 1."""


class Errors(Part):
    """Root mean squared error of three models on the same samples."""

    nominal_rmse: Number
    """Of the actuator as described, measured unit."""
    recalibrated_rmse: Number
    """With its base parameters re-estimated, measured unit."""
    final_rmse: Number
    """Of the written model, measured unit."""


class Horizon(Errors):
    """Errors of the three models some time after they have been set to the measured state, on unseen samples."""

    after: Number
    """That time [s]; null: over whole recordings from their first sample. A model that remembers long, as heat does,
    has an error there alone: no sensor shows its state."""


class FitQuality(Part):
    """What the model gained, against what no model can remove."""

    noise_floor: Number
    """Standard deviation of the sensor noise, measured unit."""
    training: Errors
    """On the samples that were fitted."""
    validation: Errors
    """On samples that neither fit nor selection used."""
    horizons: list[Horizon] = []
    """The shortest first, whole recordings last."""


class Candidate(Part):
    """An explanation that was tried."""

    id: str
    """Effect ids and parameter names, joined by +; "nominal" for none."""
    validation_rmse: Number
    """Error on samples that neither fit nor choice used, measured unit."""
    heldout_rmse: Number
    """Error on samples that no fit used and by which the model that is handed out is chosen, measured unit."""
    evidence: Number
    """What it gains in chi2 over the nominal model with its parameters re-estimated, in effective samples."""
    status: Status


class NotTestable(Part):
    """An effect that these recordings cannot show."""

    id: str
    why: str
    record: str
    """What to record to see it."""


class RuledOut(Part):
    """A strength that these recordings exclude with 95 %, of an effect that is not named."""

    id: str
    parameter: str
    below: Number = None
    """The strength is less than this, in `unit`; null where `above` says it."""
    above: Number = None
    """The value is more than this, in `unit`: of what acts the more the smaller it is, as a stiffness."""
    unit: str
    given: Literal["complete", "residual"] = "complete"
    """Whether the model is taken to be complete, or the limit counts an error that remains."""


class RemainingShape(Part):
    """What the missing torque goes with."""

    over: Over
    form: str
    """As constant, direction, linear, square, cube, once_a_turn, twice_a_turn."""
    direction: Direction = "both"
    """In which direction of the shaft it is larger."""
    share: Number
    """Of the missing torque, mean square, 0 to 1."""


class Remaining(Part):
    """What the written model leaves."""

    share: Number
    """Of the mismatch, 0 to 1; null where there is no mismatch."""
    looks_like: str
    """Its size and what it goes with, in words."""
    shapes: list[RemainingShape] = []
    """The largest share first."""


class Excluded(Part):
    """A span of time that was left out."""

    start: float
    """From the first sample [s]."""
    end: float
    """From the first sample [s]."""
    why: str


class CannotAct(Part):
    """An effect that the actuator cannot have, by its drive, load, sensor or stops."""

    id: str
    why: str


class TorqueOverTime(Part):
    """The missing torque over the first recording."""

    time: list[float]
    """Middle of each stretch, from the first sample [s]."""
    torque: list[Number]
    """Mean missing load torque while the shaft moves [N.m], positive closes; null where it does not move."""


class ResidualTorque(Part):
    """The load torque that no catalogue effect explains: bilinear between nodes, clamped at the edges."""

    angle: list[float]
    """Nodes [rad]."""
    velocity: list[float]
    """Nodes [rad/s]."""
    torque: list[list[float]]
    """At each angle (row) and velocity (column) [N.m], positive closes."""
    period: float | None = None
    """Angle [rad] after which it begins again, such as a turn; null where it does not."""
    shape: str = ""
    """What it looks like over angle, velocity and time, in words."""
    over_time: TorqueOverTime | None = None
    """What the shape over angle and velocity leaves aside: the missing torque over time."""


class Effort(Part):
    """How much was simulated."""

    simulations: int
    budget: Number = 1.0
    """What was allowed, in usual efforts; null for no limit."""
    stopped_by: Literal["budget", "interrupt", "clock"] | None = None
    """What ended the search before all was tried; after the clock or an interrupt another run may find more."""


class DataQuality(Part):
    """What the recordings are like."""

    rate: float
    """Median rate of the measured samples [Hz]."""
    jitter: float
    """Standard deviation of the sampling interval without gaps [s]."""
    gaps: int
    """Intervals longer than three median ones."""
    saturated_share: float
    """Share of time with the duty at -1 or 1."""
    stops_touched: list[str]
    """Of "closed" and "open"."""
    resolution: Number = None
    """Smallest step between measured values, measured unit."""
    excited: str
    """What was moved how far, in words."""
    limits: list[str] = []
    """What these recordings cannot tell for the way they were made, in words."""
    dirt: list[str] = []
    """What is missing, was taken out of the signals, or acted on them unmeasured, in words."""


class Simulated(Part):
    """A base parameter as the user's simulator has it."""

    described: Number
    """As the actuator is described, in `unit`."""
    value: Number
    """As fitted to the simulator's recordings, in `unit`: what the real ones are held against."""
    unit: str


class Simulation(Part):
    """The user's own simulator, in the place of the nominal model."""

    recordings: list[str]
    """Names of its recordings."""
    described_rmse: Number
    """Error of the actuator as described on them, measured unit."""
    rmse: Number
    """What the fitted equations leave of them, without their own noise, measured unit: kept apart, no evidence."""
    parameters: dict[str, Simulated]
    effects: dict[str, dict[str, float]]
    """What the equations need to reproduce it, and what the description always has; values in the catalogue's units."""


class InputFault(Part):
    """A signal that is not what it is read as, or that tells nothing of the physics."""

    recording: str
    signal: str
    """As a signal map calls it."""
    what: str
    evidence: str
    """How it shows, in words, with numbers."""
    mend: str
    """The line of a signal map that mends it, or what to do where none does."""


class Diagnosis(Part):
    """The whole document."""

    schema_number: Literal[3] = Field(3, alias="schema")
    """Version of this layout; the key is `schema`."""
    recordings: list[str]
    """Names of the recordings."""
    quantity: Literal["hall_voltage", "position", "speed"]
    unit: str
    """Measured unit."""
    input: Literal["duty", "current", "torque"] = "duty"
    """What drives the actuator."""
    motion: Literal["rotary", "linear"] = "rotary"
    """Of a linear actuator every rad is a metre, and every N.m a newton."""
    verdict: Verdict
    summary: str
    """One paragraph that a technician can read."""
    model_of: Literal["description", "re_estimated", "effects", "effects_and_shape"] = "description"
    """Which model `model.yaml` is: the one that predicts samples best that no fit used."""
    effort: Effort = Effort(simulations=0)
    effects: list[Effect] = []
    doubted: list[Doubted] = []
    """The most probable first."""
    re_estimated_share: Number = None
    """Of the mismatch of the model as described, what re-estimated parameters explain, 0 to 1."""
    parameters: dict[str, BaseParameter] = {}
    """Those of the actuator, and of effects that it always has as `effect.parameter`."""
    changes: list[Change] = []
    locations: list[Location] = Field([], max_length=20)
    """Of the first recording, ranked."""
    regimes: list[Regime] = []
    """Of the first recording."""
    simulation: Simulation | None = None
    """What the recordings were held against, where that is the user's own simulator."""
    fit: FitQuality
    candidates: list[Candidate] = []
    not_testable: list[NotTestable] = []
    ruled_out: list[RuledOut] = []
    """Of every effect that is not named and able to act, as far as these recordings tell."""
    remaining: Remaining | None = None
    excluded: list[Excluded] = []
    """Spans without a known input, or that no simulation may be held against."""
    cannot_act: list[CannotAct] = []
    """Effects that were not tried, since an actuator of this kind cannot have them."""
    residual_torque: ResidualTorque | None = None
    """Only with the verdict "unexplained"."""
    data_quality: DataQuality
    input_faults: list[InputFault] = []
    """Signals that are not what they are read as, or tell nothing; where there are any, nothing is concluded."""
    advice: list[str] = []
    """What to record next to settle what these recordings cannot."""

    def text(self) -> str:
        """The document as JSON."""
        return self.model_dump_json(indent=1, by_alias=True) + "\n"

    def write(self, path: Path) -> None:
        """Write the document to `path`."""
        path.write_text(self.text(), encoding="utf-8")

    @staticmethod
    def read(path: Path) -> Diagnosis:
        """The document at `path`."""
        return Diagnosis.model_validate_json(path.read_text(encoding="utf-8"))
