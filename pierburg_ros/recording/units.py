"""Units as signal maps and tables write them: those of SI with prefixes, and deg, rpm, percent and counts."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass

PREFIXES = {
    "": 1.0, "p": 1e-12, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "c": 1e-2, "d": 1e-1, "k": 1e3,
    "M": 1e6, "G": 1e9,
}  # fmt: skip
"""Factor of each prefix of SI."""
BASE = ("rad", "V", "A", "N", "m", "s", "degC")
OTHER_UNITS: dict[str, tuple[float, dict[str, int]]] = {
    "1": (1.0, {}),
    "percent": (0.01, {}),
    "%": (0.01, {}),
    "fraction": (1.0, {}),
    "deg": (math.pi / 180.0, {"rad": 1}),
    "degree": (math.pi / 180.0, {"rad": 1}),
    "degrees": (math.pi / 180.0, {"rad": 1}),
    "°": (math.pi / 180.0, {"rad": 1}),
    "rev": (2.0 * math.pi, {"rad": 1}),
    "turn": (2.0 * math.pi, {"rad": 1}),
    "rpm": (2.0 * math.pi / 60.0, {"rad": 1, "s": -1}),
    "Hz": (1.0, {"s": -1}),
    "min": (60.0, {"s": 1}),
    "°C": (1.0, {"degC": 1}),
}
"""Factor to SI and exponents of the units of SI, for units that are none of it."""
USUAL = (
    *("V", "mV", "A", "mA", "uA", "N.m", "mN.m", "N", "rad", "mrad", "deg", "rev", "rad/s", "deg/s", "rpm", "m", "mm"),
    *("m/s", "mm/s", "s", "ms", "us", "ns", "degC", "percent", "counts"),
)
"""Units that a wrong one may be meant for."""
COUNTS = "counts"
"""Steps of a converter: what one is worth is the scale of its signal."""
LONGEST_UNIT = 40
"""Characters of a unit at most."""
PART = re.compile(r"(?P<mark>[./*·]?)(?P<name>[^./*·^\s]+?)(?P<power>\^?-?[12])?(?=[./*·]|$)")


@dataclass(frozen=True)
class Unit:
    """A unit as written: its factor to SI, and the exponents of the units of SI in it."""

    written: str
    factor: float
    exponents: dict[str, int]

    def measures(self, wanted: str) -> bool:
        """Whether it is a unit of what `wanted`, a unit of SI, measures; counts are of anything."""
        return self.written == COUNTS or self.exponents == unit_of(wanted).exponents


def unit_of(written: str) -> Unit:
    """The unit that is `written`; ValueError where it is not known."""
    if written == COUNTS:
        return Unit(written, 1.0, {})
    if written in OTHER_UNITS:
        factor, others = OTHER_UNITS[written]
        return Unit(written, factor, others)
    text = written.replace("Nm", "N.m")
    if not text or len(text) > LONGEST_UNIT or text[0] in "./*·":
        raise ValueError(f"{written[:LONGEST_UNIT]!r} is no unit")
    total, exponents, place = 1.0, Counter[str](), 0
    for part in PART.finditer(text):
        if part.start() != place:
            break
        place = part.end()
        power = int((part["power"] or "1").removeprefix("^")) * (-1 if part["mark"] == "/" else 1)
        factor, found = simple(part["name"])
        total *= factor**power
        exponents.update({base: power * exponent for base, exponent in found.items()})
    if place != len(text):
        raise ValueError(f"{written!r} is no unit")
    return Unit(written, total, {base: exponent for base, exponent in exponents.items() if exponent})


def simple(name: str) -> tuple[float, dict[str, int]]:
    """Factor and exponents of one unit without a product; with its prefix, where it is one of SI."""
    if name in OTHER_UNITS:
        return OTHER_UNITS[name]
    for base in BASE:
        if name.endswith(base) and name.removesuffix(base) in PREFIXES:
            return PREFIXES[name.removesuffix(base)], {base: 1}
    raise ValueError(f"{name!r} is no unit")
