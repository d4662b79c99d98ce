"""Numbers for people: with as many digits as they need, and no more."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

NONE = "-"
FEWEST_DIGITS = 3
"""Digits of a value whose interval is wide. Chosen: with one, 2.54 beside 2.8 reads as more."""
MOST_DIGITS = 9
"""Digits beyond which none is shown. Derived: a double has 16, a person reads a phone number."""


def number(value: float | None, digits: int = 4) -> str:
    """A number; a dash where there is none."""
    return NONE if value is None else f"{value:.{digits}g}"


def whole(value: float | None) -> str:
    """A large number without a fraction, its thousands apart; a dash where there is none."""
    return NONE if value is None else f"{value:,.0f}"


def interval(ends: Sequence[float] | None) -> str:
    """Both ends of an interval, with digits enough to tell them apart to a tenth; a dash where there is none."""
    if ends is None:
        return NONE
    return " to ".join(_shown(end, ends) for end in ends)


class Known(Protocol):
    """A value of which something is known (`diagnosis.schema.Estimate`)."""

    ci95: tuple[float, float] | None
    identifiable: bool
    at_bound: bool
    tied_with: list[str]


def known(estimate: Known) -> str:
    """What is known of a value: its interval, or why there is none to act on."""
    if estimate.at_bound:
        return "on a bound of the search"
    if estimate.identifiable:
        return interval(estimate.ci95) if estimate.ci95 else "fixed by the samples"
    if estimate.tied_with:
        return f"shows only with {' and '.join(map(words, estimate.tied_with))}"
    return f"{interval(estimate.ci95)}, too wide to act on" if estimate.ci95 else "not determined"


def value(middle: float | None, ends: Sequence[float] | None = None) -> str:
    """A value with as many digits as its interval has, and no less than `FEWEST_DIGITS`; a dash where there is none."""
    if middle is None or ends is None:
        return number(middle)
    shown = _shown(middle, (*ends, middle))
    is_close = abs(float(shown) - middle) <= 0.5 * 10.0 ** (1 - FEWEST_DIGITS) * abs(middle)
    return shown if is_close else number(middle, FEWEST_DIGITS)


def _shown(middle: float, among: Sequence[float]) -> str:
    """A value with digits enough to tell the least and the largest `among` several apart to a tenth."""
    width = max(among) - min(among)
    largest = max(abs(each) for each in among)
    if width <= 0.0 or not math.isfinite(width) or largest == 0.0:
        return number(middle)
    places = 1 - math.floor(math.log10(width))
    places = min(places, MOST_DIGITS - 1 - math.floor(math.log10(largest)))
    if largest >= 1e6 or largest < 1e-4:
        return f"{middle:.{max(places + math.floor(math.log10(largest)), 0)}e}"
    return f"{middle:.{max(places, 0)}f}"


def confidence(share: float | None) -> str:
    """A confidence: never a round 1, which nothing is."""
    return "above 0.999" if share is not None and share > 0.999 else number(share, 3)


def percent(share: float | None) -> str:
    """A share in per cent: a digit after the point below 10 %."""
    if share is None:
        return NONE
    if 0.0 < share < 0.0005:
        return "below 0.1 %"
    return f"{100.0 * share:.{0 if share == 0.0 or share >= 0.0995 else 1}f} %"


def width(share: float | None) -> str:
    """A share as the length of a bar in a style: within 0 and 100 %."""
    return f"{100.0 * min(max(share or 0.0, 0.0), 1.0):.1f}%"


def unit(name: str) -> str:
    """A unit behind a value; nothing for a pure number."""
    return "" if name == "1" else f" {name}"


def words(name: str) -> str:
    """A name of the catalogue as words."""
    return name.replace("_", " ").replace("+", " + ").replace(".", ": ").replace("@time", " (changes)")


def ties(alternatives: Sequence[Sequence[str]]) -> str:
    """Alternatives, each several names, as words."""
    return "; or ".join(" with ".join(words(name) for name in tie) for tie in alternatives)


FILTERS = {
    "number": number,
    "whole": whole,
    "interval": interval,
    "known": known,
    "value": value,
    "confidence": confidence,
    "percent": percent,
    "width": width,
    "unit": unit,
    "words": words,
    "ties": ties,
}
"""How a template shows numbers."""
