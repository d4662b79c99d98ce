"""The declaration of a number or a choice: name, unit, range, meaning, origin. Everything settable is declared so."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral, Real

from pierburg_ros.errors import InputError

Value = bool | int | float | str | list[str]


@dataclass(frozen=True)
class Parameter:
    """One parameter of an actuator, an effect, the controller or a node.

    Its type is that of the default. A default of None is a number that must be given. A `fixed` one is read at the
    start only. `choices`, where there are any, are all that is allowed.
    """

    name: str
    default: Value | None
    meaning: str
    unit: str = ""
    minimum: float = -math.inf
    maximum: float = math.inf
    fixed: bool = False
    choices: tuple[str, ...] | tuple[float, ...] = ()
    origin: str = ""

    @property
    def description(self) -> str:
        """Meaning with unit, for people."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.meaning}{unit}"

    @property
    def allowed(self) -> str:
        """What is allowed, in words."""
        if self.choices:
            return " or ".join(f"{choice:g}" if isinstance(choice, float) else choice for choice in self.choices)
        unit = f" {self.unit}" if self.unit not in ("", "1") else ""
        if math.isinf(self.minimum) or math.isinf(self.maximum):
            return f"a finite number{unit and ' of' + unit}"
        return f"{self.minimum:g} to {self.maximum:g}{unit}"

    def accepted(self, value: object, name: str | None = None) -> Value:
        """`value` in the declared type; InputError where its type or range is another. `name`: as people know it."""
        label = name or self.name
        expected = float if self.default is None else type(self.default)
        if expected is float and isinstance(value, Real) and not isinstance(value, bool):
            value = _double(value)
        if expected is int and isinstance(value, Integral) and not isinstance(value, bool):
            value = int(value)
        if expected is list and isinstance(value, tuple):
            value = list(value)
        texts = not isinstance(value, list) or all(isinstance(each, str) for each in value)
        if type(value) is not expected or not texts:
            raise InputError(f"{label} is {_shown(value)}; expected {_WORDS[expected]}.")
        if self.choices and value not in self.choices:
            raise InputError(f"{label} is {_shown(value)}; expected {self.allowed}.")
        if isinstance(value, (int, float)) and not isinstance(value, bool) and not self.holds(value):
            raise InputError(f"{label} is {value:g}; expected {self.allowed}.")
        return value

    def holds(self, value: float) -> bool:
        """Whether a number is finite and in the range."""
        return math.isfinite(value) and self.minimum <= value <= self.maximum


def _double(value: Real) -> float:
    """`value` as a double, infinite where it is too large for one."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _shown(value: object) -> str:
    """`value` as a message quotes it: not more than a person reads."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


_WORDS = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "a text",
    list: "a list of texts",
}
