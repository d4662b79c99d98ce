"""How much a diagnosis may simulate: in usual efforts, which are the same on every machine, or until a time is over."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.errors import InputError

SIMULATIONS = 20_000
"""Simulations in a usual effort. Work: twice what two effects beside four drifts took."""


class OutOfTime(BaseException):
    """The seconds of a budget are over: like an interrupt from the keyboard it waits for nothing."""


@dataclass(frozen=True)
class Budget:
    """So many `efforts`, infinite for no limit, and at most so many `seconds` of a clock."""

    efforts: float = 1.0
    seconds: float = math.inf

    @property
    def simulations(self) -> float:
        """Simulations after which no larger explanation is tried."""
        return self.efforts * SIMULATIONS

    @staticmethod
    def of(given: Budget | float | str | None) -> Budget:
        """What is meant by a number of usual efforts, by seconds such as "60s", or by None, no limit.

        InputError where it is neither.
        """
        if isinstance(given, Budget):
            return given
        if given is None:
            return Budget(math.inf)
        text = str(given).strip()
        seconds = text.endswith("s")
        try:
            value = float(text.removesuffix("s"))
        except ValueError:
            value = math.nan
        if not value > 0.0:
            raise InputError(
                f"the budget is {text!r}; expected usual efforts such as 2 or 0.5, or seconds such as 60s."
            )
        return Budget(seconds=value) if seconds else Budget(value)


USUAL_BUDGET = Budget()
"""What a diagnosis may take unless told otherwise."""
