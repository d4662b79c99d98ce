"""A diagnosis on the terminal: verdict, effects, drifts, errors, advice."""

from __future__ import annotations

from rich.console import Group
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from pierburg_ros.diagnosis.schema import Diagnosis, RuledOut
from pierburg_ros.pages.numbers import interval, unit, value


def shown(diagnosis: Diagnosis) -> Group:
    """What a terminal shows of a diagnosis."""
    verdict = diagnosis.verdict.replace("_", " ")
    parts: list[Panel | Table | Text] = [Panel(diagnosis.summary, title=verdict, expand=False)]
    if diagnosis.effects or any(p.drifted for p in diagnosis.parameters.values()):
        parts.append(_changed(diagnosis))
    parts.append(_errors(diagnosis))
    if diagnosis.locations:
        places = "; ".join(f"{p.start:.1f} to {p.end:.1f} s ({p.regime})" for p in diagnosis.locations[:3])
        parts.append(Text(f"Where: {places}"))
    if diagnosis.ruled_out:
        parts.append(Text(f"Ruled out (95 %): {'; '.join(ruled_out(limit) for limit in diagnosis.ruled_out)}"))
    parts += [Text(f"Next: {step}") for step in diagnosis.advice[:3]]
    return Group(*parts)


def ruled_out(limit: RuledOut) -> str:
    """What a recording excludes, in a few words."""
    side, value = ("more", limit.above) if limit.above is not None else ("less", limit.below)
    unit = "" if limit.unit == "1" else f" {limit.unit}"
    return f"{limit.id}, {limit.parameter.replace('_', ' ')} {side} than {value:.2g}{unit}"


def _changed(diagnosis: Diagnosis) -> Table:
    table = Table("what", "value", "95 %", "cannot be told from")
    for effect in diagnosis.effects:
        ties = "; ".join(" with ".join(tie) for tie in effect.indistinguishable_from)
        for name, estimate in effect.parameters.items():
            table.add_row(f"{effect.id}.{name}", *_number(estimate.value, estimate.unit, estimate.ci95), ties)
    for name, parameter in diagnosis.parameters.items():
        if parameter.drifted:
            ties = "; ".join(" with ".join(tie) for tie in parameter.indistinguishable_from)
            table.add_row(name, *_number(parameter.value, parameter.unit, parameter.ci95), ties)
    return table


def _number(middle: float | None, name: str, ends: tuple[float, float] | None) -> tuple[str, str]:
    shown = value(middle, ends) + unit(name) if middle is not None else ""
    return shown, interval(ends) if ends else ""


def _errors(diagnosis: Diagnosis) -> Table:
    unit = diagnosis.unit
    table = Table(f"RMSE [{unit}]", "nominal", "recalibrated", "final", "noise")
    for label, errors in (("fitted data", diagnosis.fit.training), ("unseen data", diagnosis.fit.validation)):
        row = (errors.nominal_rmse, errors.recalibrated_rmse, errors.final_rmse, diagnosis.fit.noise_floor)
        table.add_row(label, *("" if value is None else f"{value:.4g}" for value in row))
    return table
