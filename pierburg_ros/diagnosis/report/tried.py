"""The explanations that were tried, one row for each name, with the error of each beside the chosen one."""

from __future__ import annotations

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.found import Found
from pierburg_ros.diagnosis.result import Tried
from pierburg_ros.diagnosis.schema import Status
from pierburg_ros.inference.choice import Score
from pierburg_ros.inference.evidence import rms
from pierburg_ros.inference.explanation import WHEN, quantities
from pierburg_ros.inference.fit import Fit, adequate
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


def statuses(found: Found) -> dict[str, Status]:
    """Status by name: chosen, tied (fits as well, and does not contain the chosen one) or rejected."""
    choice = found.choice
    own, score = set(quantities(choice.handed.explanation)), Score.of(choice.fits)
    result: dict[str, Status] = {}
    for fit in choice.fits:
        alike = score.alike(fit, choice.handed) and adequate(fit) and not own < set(quantities(fit.explanation))
        result.setdefault(identifier(fit), "tied" if alike and own else "rejected")
    return {**result, identifier(choice.handed): "chosen"}


def rivals(found: Found) -> list[tuple[Tried, Signal]]:
    """The model that is handed out and all other explanations, the best first, with what each leaves over all runs."""
    choice, status, handed = found.choice, statuses(found), found.written
    score = Score.of(choice.fits)

    def row(fit: Fit, name: str, how: Status, key: str) -> tuple[Tried, Signal]:
        residual = found.errors["final"] if fit is handed else found.residual(fit)
        lack = score.lack(fit.chi2) - score.lack(choice.handed.chi2)
        return tried(found, residual, name, fit.size, how, lack, key), residual

    own = shortened(choice.handed, choice.estimated)
    rows = [row(choice.handed, own, "chosen", "final" if handed is choice.handed else "chosen")]
    if handed is not choice.handed:
        name = shortened(handed, choice.estimated)
        shaped = f"{name}+{SHAPE}" if handed.model.residual_torque is not None else name
        rows.insert(0, row(handed, shaped, "rejected", "final"))
    listed = {identifier(choice.handed): choice.handed}
    for fit in sorted(choice.fits, key=lambda fit: fit.chi2):
        listed.setdefault(identifier(fit), fit)
    others = [(name, fit) for name, fit in listed.items() if fit is not choice.handed and fit is not handed]
    rows += [
        row(fit, name, status[name], f"rival-{place}" if place < DRAWN else "")
        for place, (name, fit) in enumerate(others)
    ]
    return rows


def tried(found: Found, residual: Signal, name: str, size: int, how: Status, lack: float, key: str) -> Tried:
    """A row on a model that leaves a `residual` [measured unit] over all runs."""
    data = found.data
    training = rms(residual[data.train])
    return Tried(name, size, how, training, rms_or_none(residual[data.test]), lack, key)


def rms_or_none(residual: Signal) -> float | None:
    """Root mean square; None where there are no samples."""
    return rms(residual) if residual.size else None


SHAPE = "map_of_the_missing_torque"
"""Name of what is added to an explanation as a torque over angle and velocity."""
