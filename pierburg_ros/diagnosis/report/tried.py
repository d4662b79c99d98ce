"""The explanations that were tried, one row for each name, with the error of each beside the chosen one."""

from __future__ import annotations

from dataclasses import replace

from pierburg_ros.diagnosis.result import Tried
from pierburg_ros.diagnosis.schema import Status
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.selection import alike as closest
from pierburg_ros.diagnosis.search.selection import tied
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion
from pierburg_ros.estimation.data import rms
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.inference.explanation import WHEN, quantities
from pierburg_ros.pages.numbers import words

DRAWN = 5
"""Number of rivals whose error is drawn. Work: each adds 0.1 MB to the page of a minute at 500 Hz; the others are in
the table alone."""
NOMINAL = "nominal"
"""Name of the explanation that changes nothing."""
RECALIBRATED = "parameters_re-estimated"
"""Replaces the names of all re-estimated parameters, which may be many, in the name of an explanation."""
OFF = "off-"
"""Prefix to the id of an effect: the name of the final model with that effect switched off."""


def title(row: Tried) -> str:
    """An explanation in words."""
    off = row.name.startswith(OFF)
    return f"{words(row.name.removeprefix(OFF))} switched off" if off else words(row.name)


def identifier(fit: Fit) -> str:
    """Effect ids and parameter names joined by +; `nominal` for none."""
    change = (f"{fit.explanation.changed}{WHEN}",) if fit.explanation.changed else ()
    return "+".join((*fit.explanation.drifted, *change, *fit.explanation.effects)) or NOMINAL


def shortened(fit: Fit, recalibrated: Fit) -> str:
    """The identifier of an explanation, with one name for all parameters if it has all of the recalibrated one."""
    own, drifted = recalibrated.explanation.drifted, fit.explanation.drifted
    if len(own) < 2 or not set(own) <= set(drifted):
        return identifier(fit)
    others = [name for name in identifier(fit).split("+") if name not in own]
    return "+".join([RECALIBRATED, *others])


def distinct(found: Found, chosen: Fit) -> list[Fit]:
    """The chosen fit, then the best fit of every other name, the best first."""
    best = {identifier(chosen): chosen}
    for fit in sorted(found.fits.values(), key=lambda fit: fit.chi2):
        best.setdefault(identifier(fit), fit)
    return list(best.values())


def statuses(found: Found, chosen: Fit) -> dict[str, Status]:
    """Status by name: chosen, tied (fits neither worse nor better, and does not contain the chosen one) or rejected."""
    own = set(quantities(chosen.explanation))
    least = 2.0 * chosen.misfit - closest(chosen)
    equals = [fit for fit in tied(chosen, found.fits.values(), found.estimator) if fit.misfit >= least]
    alike = {identifier(fit) for fit in equals if not own < set(quantities(fit.explanation))}
    if not own:
        alike = set()
    alike.discard(identifier(chosen))
    result: dict[str, Status] = {identifier(fit): "rejected" for fit in found.fits.values()}
    result.update(dict.fromkeys(alike, "tied"))
    return {**result, identifier(chosen): "chosen"}


def rivals(found: Found, conclusion: Conclusion) -> list[tuple[Tried, Fit]]:
    """The chosen explanation with its last values, what ties with it or fits better, and all others of its size.

    If nothing was added to the nominal model, these others are explanations with one quantity.
    """
    chosen = conclusion.chosen
    status = statuses(found, chosen)
    size = max(chosen.explanation.size, 1)
    clear = chosen.misfit - SIGNIFICANT * chosen.repetition
    others = [
        fit
        for fit in distinct(found, chosen)[1:]
        if status[identifier(fit)] == "tied" or fit.explanation.size == size or fit.misfit < clear
    ]
    others.sort(key=lambda fit: (status[identifier(fit)] != "tied", fit.chi2))
    name = shortened(chosen, conclusion.recalibrated)
    rows = [(_row(found, conclusion, conclusion.final, "chosen", name), conclusion.final)]
    for place, fit in enumerate(others):
        name = identifier(fit)
        row = _row(found, conclusion, fit, status[name], name)
        rows.append((replace(row, key=f"rival-{place}" if place < DRAWN else ""), fit))
    return rows


def _row(found: Found, conclusion: Conclusion, fit: Fit, status: Status, name: str) -> Tried:
    data, chosen = found.data, conclusion.chosen
    model = conclusion.model if status == "chosen" else fit.model
    residual = data.residual(model, fit.switch) * data.noise
    unseen = residual[data.test]
    lack = 0.0 if status == "chosen" else (fit.misfit - chosen.misfit) / chosen.repetition
    return Tried(
        name,
        fit.explanation.size,
        status,
        rms(residual[data.train]),
        rms(unseen) if unseen.size else None,
        lack,
        "final" if status == "chosen" else "",
    )
