"""What one trial on a real recording changes, and the label that is sealed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from pierburg_ros.effects import EFFECT
from pierburg_ros.plant import Model
from pierburg_ros.proof.real.visibility import Visibility

UNTOUCHED = "untouched"
WITHHELD = "withheld_supply"
"""The logged supply voltage is left out. It wanders as it did, which no effect is: none may be named for it."""


@dataclass(frozen=True)
class Trial:
    """One real recording, and what is changed: an effect, a number of the description, what is logged, or nothing.

    `kind` is the effect's id, the base parameter's name, `WITHHELD` or `UNTOUCHED`.
    """

    recording: str
    half: int
    kind: str = UNTOUCHED
    level: str = "plain"

    @property
    def name(self) -> str:
        """That of its folder."""
        parts = [self.recording, self.kind] if self.kind == UNTOUCHED else [self.recording, self.kind, self.level]
        return "-".join(parts)

    @property
    def is_effect(self) -> bool:
        """Whether an effect is put in."""
        return self.kind in EFFECT


@dataclass(frozen=True)
class Truth:
    """What was changed: the `strength` of an effect that was put in, or a factor on a number of the description.

    `true` is the value by dotted name that the diagnosis should come to: what is put in adds to what the model of the
    other recordings has of the effect already, and a wrong number is right where that model has it. `visibility` says
    how far that stands out of what remains there, None where nothing is looked for.
    """

    trial: Trial
    strength: float | None = None
    true: Mapping[str, float] = field(default_factory=dict)
    limit: float | None = None
    visibility: Visibility | None = None

    def label(self) -> dict[str, Any]:
        """As it is sealed."""
        trial = self.trial
        return {
            "id": trial.name,
            "recording": trial.recording,
            "half": trial.half,
            "kind": trial.kind,
            "level": trial.level,
            "strength": self.strength,
            "limit": self.limit,
            "true": dict(self.true),
            "shown": self.visibility and self.visibility.shown,
            "visibility": self.visibility and asdict(self.visibility),
        }


def added(effect: str, values: Mapping[str, float], model: Model) -> dict[str, float]:
    """The strength that a machine like `model` has of an effect once more of it is put in, by dotted name.

    Delays, dead bands, plays in a row and small lags and bends add up; of two converters the coarser counts.
    """
    declared = EFFECT[effect]
    name = f"{effect}.{declared.strength[0]}"
    own, more = model.values[name], values[declared.strength[0]]
    return {name: max(own, more) if declared.rounds else own + more}
