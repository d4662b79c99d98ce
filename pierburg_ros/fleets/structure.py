"""With which model a fleet's recordings are measured, so that its courses compare like with like.

A diagnosis explains one recording by the fewest quantities: of two recordings of one unit the first may be explained by
a resistance, the second by a torque constant, and a third, in which both are within the noise, by nothing. So after all
have been diagnosed every recording is fitted once more, with the base parameters that the fleet's diagnoses change, all
together, beside the effects that its own diagnosis names.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from pierburg_ros.effects import EFFECT

FEWEST_DIAGNOSES = 2
"""Recordings whose diagnoses must change a base parameter. Chosen: one alone may be chance; not varied."""
HALF = 0.5
"""Share of the recordings that must determine a base parameter of the common model. Chosen: a course of one below has
more gaps than points; not varied."""
RARE_SHARE = 0.02
"""Share of all recordings below which a base parameter is left out. Chosen: of 1,000 recordings one unit's 25 count;
not varied."""


def explained(result: Mapping[str, Any]) -> bool:
    """Whether a diagnosis has come to its end and explains its recording; otherwise it may change anything."""
    return not result["stopped"] and result["verdict"] != "unexplained"


def base_names(findings: Sequence[Sequence[Mapping[str, Any]]]) -> tuple[str, ...]:
    """The base parameters that diagnoses of a fleet change, those that most of them change first."""
    counts = Counter(each["name"] for found in findings for each in found if each["kind"] == "parameter")
    least = max(FEWEST_DIAGNOSES, RARE_SHARE * len(findings))
    return tuple(name for name, count in counts.most_common() if count >= least)


def own_effects(found: Sequence[Mapping[str, Any]]) -> tuple[dict[str, float], tuple[str, ...]]:
    """The values of the effects that a diagnosis names, and those of their parameters that are measured again.

    What belongs to one recording, as the moment of a load, stays as it was found.
    """
    values = {each["name"]: each["value"] for each in found if each["kind"] == "effect" and each["value"] is not None}
    free = []
    for name, value in values.items():
        effect, _, own = name.partition(".")
        parameter = EFFECT[effect].parameter(own)
        if value and not (parameter.choices or parameter.dated or parameter.rhythm):
            free.append(name)
    return values, tuple(free)


def without_least(names: Sequence[str], determined: Mapping[str, float]) -> tuple[str, ...]:
    """The base parameters less the last of those that half the recordings leave undetermined, if there is one.

    Where some cannot be told apart, all of these are undetermined, and the one that most diagnoses change stays.
    """
    poor = [name for name in names if determined.get(name, 1.0) < HALF]
    return tuple(name for name in names if name != poor[-1]) if poor else tuple(names)
