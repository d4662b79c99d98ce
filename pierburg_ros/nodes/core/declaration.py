"""A parameter as a person sees it, and the check of a value against it. Knows no ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pierburg_ros.errors import InputError

Value = bool | int | float | str | list[str]


@dataclass(frozen=True)
class Declaration:
    """One parameter of a node; its type is that of the default, a `fixed` one is read at the start only."""

    name: str
    default: Value
    meaning: str
    unit: str = ""
    minimum: float = -math.inf
    maximum: float = math.inf
    fixed: bool = False
    choices: tuple[str, ...] = ()

    @property
    def description(self) -> str:
        """Meaning with unit, for people."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.meaning}{unit}"

    def accepted(self, value: object) -> Value:
        """`value` in the declared type; InputError where its type or range is another."""
        if isinstance(self.default, bool) or not isinstance(self.default, (int, float)):
            return self._of_type(value, type(self.default))
        if isinstance(self.default, float) and type(value) is int:
            value = float(value)
        number: Any = self._of_type(value, type(self.default))
        if not (math.isfinite(number) and self.minimum <= number <= self.maximum):
            raise InputError(f"{self.name} is {number:g}; expected {self._range()}.")
        return number  # type: ignore[no-any-return]

    def _of_type(self, value: object, expected: type) -> Value:
        if expected is list and isinstance(value, tuple):
            value = list(value)
        texts = not isinstance(value, list) or all(isinstance(each, str) for each in value)
        if type(value) is not expected or not texts:
            raise InputError(f"{self.name} is {value!r}; expected {_WORDS[expected]}.")
        if self.choices and value not in self.choices:
            raise InputError(f"{self.name} is {value!r}; expected {' or '.join(self.choices)}.")
        return value  # type: ignore[return-value]

    def _range(self) -> str:
        unit = f" {self.unit}" if self.unit not in ("", "1") else ""
        if math.isinf(self.minimum) or math.isinf(self.maximum):
            return f"a finite number{unit and ' of' + unit}"
        return f"{self.minimum:g} to {self.maximum:g}{unit}"


_WORDS = {
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    str: "a text",
    list: "a list of texts",
}
