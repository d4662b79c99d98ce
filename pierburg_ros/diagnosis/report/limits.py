"""How much of an effect that is not named the recordings still allow, beside how large it is typically."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from pierburg_ros.effects import EFFECT


@dataclass(frozen=True)
class Bar:
    """An effect, the limit of its strength in words, and that limit as a share of a typical strength."""

    name: str
    text: str
    share: float


def bars(ruled_out: Iterable[Mapping[str, Any]], values: Mapping[str, float]) -> list[Bar]:
    """What is left of each effect of `ruled_out`, the most excluded first; `values` are the final model's."""
    found = []
    for item in ruled_out:
        effect = EFFECT[item["id"]]
        unit = "" if item["unit"] == "1" else f" {item['unit']}"
        name, above = effect.id.replace("_", " "), item.get("above")
        typical = effect.typical.get(item["parameter"], 0.0)
        base = effect.parameter(item["parameter"]).above
        start = values[base] if base is not None else 0.0
        if above is not None and above > 0.0 and typical > 0.0:
            found.append(Bar(name, f"above {above:.3g}{unit}", typical / above))
        elif item["below"] is not None and item["below"] > start and typical > 0.0:
            found.append(Bar(name, f"below {item['below']:.3g}{unit}", (item["below"] - start) / typical))
    return sorted(found, key=lambda bar: bar.share)
