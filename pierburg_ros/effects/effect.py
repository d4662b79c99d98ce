"""What an effect declares: its parameters, where it acts, where it shows, and where its equation comes from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Stage = Literal["input", "drive", "transmission", "load", "friction", "sensor"]

LUGRE = "Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Automatic Control 40 (1995) 419-425"
ARMSTRONG = "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083-1138"
CONTRACT = "section 7 of docs/contract.md"


@dataclass(frozen=True)
class Parameter:
    """One number of an effect.

    `minimum` and `maximum` bound what is accepted and what a fit may try; `plausible` is the range in which
    a search starts. A `default` of None means that the number must be given once the effect is active.
    """

    name: str
    unit: str
    minimum: float
    maximum: float
    plausible: tuple[float, float]
    meaning: str
    default: float | None = None
    choices: tuple[float, ...] = ()


@dataclass(frozen=True)
class Effect:
    """One physical phenomenon; with every strength parameter at zero it is absent, bit for bit."""

    id: str
    stage: Stage
    sentence: str
    equation: str
    origin: str
    shows_in: str
    record: str
    parameters: tuple[Parameter, ...]
    strength: tuple[str, ...]

    def parameter(self, name: str) -> Parameter:
        """The declaration of the parameter called `name`; KeyError where there is none."""
        return {p.name: p for p in self.parameters}[name]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of the declaration."""
        return tuple(p.name for p in self.parameters)
