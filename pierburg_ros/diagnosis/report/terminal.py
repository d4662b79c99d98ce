"""A diagnosis on the terminal: verdict, effects with their confidence, drifts, errors, advice."""

from __future__ import annotations

from collections.abc import Sequence

from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.panel import Panel
from rich.text import Text

from pierburg_ros.diagnosis.schema import BaseParameter, Diagnosis, Estimate, RuledOut
from pierburg_ros.pages.listing import Listing
from pierburg_ros.pages.numbers import confidence, known, ties, unit, value, words


def shown(diagnosis: Diagnosis) -> Group:
    """The parts of a diagnosis that a terminal shows."""
    verdict = diagnosis.verdict.replace("_", " ")
    parts: list[RenderableType] = [Panel(Text(diagnosis.summary), title=verdict, expand=False)]
    if (changed := _changed(diagnosis)).rows:
        parts.append(changed)
    if diagnosis.effects:
        sure = (f"{words(effect.id)} {confidence(effect.confidence)}" for effect in diagnosis.effects)
        parts.append(Text(f"Confidence: {', '.join(sure)}"))
    if not diagnosis.input_faults:  # then no model was simulated
        parts.append(_errors(diagnosis))
    if diagnosis.locations:
        places = "; ".join(f"{p.start:.1f} to {p.end:.1f} s ({p.regime})" for p in diagnosis.locations[:3])
        parts.append(Text(f"Where: {places}"))
    if diagnosis.ruled_out:
        limits = [Text(ruled_out(limit)) for limit in diagnosis.ruled_out]
        parts += [Text("Ruled out (95 %):"), Padding(Columns(limits, column_first=True, padding=(0, 3)), (0, 0, 0, 2))]
    parts += [Text(f"Next: {step}") for step in diagnosis.advice[:3]]
    return Group(*parts)


def ruled_out(limit: RuledOut) -> str:
    """The strength that a recording excludes, in a few words."""
    sign, end = ("<", limit.above) if limit.above is not None else (">", limit.below)
    return f"{limit.id}.{limit.parameter} {sign} {end:.2g}{unit(limit.unit)}"


def _changed(diagnosis: Diagnosis) -> Listing:
    rows = [
        _row(f"{effect.id}.{name}", estimate, effect.indistinguishable_from)
        for effect in diagnosis.effects
        for name, estimate in effect.parameters.items()
    ]
    rows += [
        _row(name, parameter, parameter.indistinguishable_from)
        for name, parameter in diagnosis.parameters.items()
        if parameter.value != parameter.nominal
    ]
    return Listing(("what", "value", "95 %", "cannot be told from"), rows)


def _row(name: str, estimate: Estimate | BaseParameter, alternatives: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """Name, value, interval, and the quantities from which it is not distinguished."""
    ends = estimate.ci95
    shown = value(estimate.value, ends) + unit(estimate.unit) if estimate.value is not None else ""
    return name, shown, known(estimate), ties(alternatives)


def _errors(diagnosis: Diagnosis) -> Listing:
    rows = [
        (
            f"RMSE [{diagnosis.unit}], {label}",
            *(
                "" if each is None else f"{each:.4g}"
                for each in (
                    errors.nominal_rmse,
                    errors.recalibrated_rmse,
                    errors.final_rmse,
                    diagnosis.fit.noise_floor,
                )
            ),
        )
        for label, errors in (("fitted data", diagnosis.fit.training), ("unseen data", diagnosis.fit.validation))
    ]
    return Listing(("error", "as described", "re-estimated", "diagnosed", "noise"), rows)
