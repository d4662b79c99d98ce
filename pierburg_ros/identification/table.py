"""An identification and the audit as tables for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.identification.identify import Identification
from pierburg_ros.identification.paper.step_response import primitive_parameters
from pierburg_ros.identification.paper.table_one import Check
from pierburg_ros.pages.listing import Listing

COLUMNS = ("value", "unit", "95 % interval")


def parameter_table(found: Identification) -> Listing:
    """Every parameter: fitted or held, with its interval where it has one."""
    rows = []
    for name, entry in found.as_mapping()["parameters"].items():
        shown = "held" if entry["fixed"] else interval(entry["ci95"])
        rows.append((name, f"{entry['value']:.6g}", entry["unit"], shown))
    return Listing(("parameter", *COLUMNS), rows, "Parameters, from the fit of whole recordings")


def interval(ends: Sequence[float] | None) -> str:
    """Both ends of an interval, or that the recordings do not determine the number."""
    return "not identifiable" if ends is None else "{:.6g} to {:.6g}".format(*ends)


def reasons(found: Identification) -> list[str]:
    """A sentence for each parameter that these recordings do not determine, and one on a torque over a turn."""
    said = [f"{name}: {finding.reason}" for name, finding in found.findings.items() if not finding.identifiable]
    return [found.repeated, *said] if found.repeated else said


def lump_table(found: Identification) -> Listing | None:
    """The lumps of sliding motion, and D_c and D_pre; None for an actuator without a spring."""
    if found.lumps is None:
        return None
    rows = [(name, f"{lump.value:.6g}", lump.unit, interval(lump.ci95)) for name, lump in found.lumps.items()]
    source = "settled angles" if found.static is not None else "the fit"
    for name, duty in (found.as_mapping()["static_characteristic"] or {}).items():
        rows.append((f"{name}, from {source}", f"{duty['value']:.6g}", "1", interval(duty["ci95"])))
    return Listing(("quantity", *COLUMNS), rows, "What sliding motion shows, whatever is held")


def paper_table(found: Identification) -> Listing | None:
    """The paper's procedure beside the fit; None where the recordings hold no steps from rest."""
    if found.steps is None or found.static is None:
        return None
    values, steps, unit_of = found.fitted.model.values, found.steps, found.model.actuator.unit_of
    rows = [
        (name, f"{value:.5g}", f"{values[name]:.5g}", unit_of(name))
        for name, value in primitive_parameters(steps, found.static, values).items()
    ]
    for name, value, deviation, unit in (
        ("K", steps.gain, steps.gain_deviation, "rad/V"),
        ("p1", steps.slow_pole, steps.slow_pole_deviation, "rad/s"),
    ):
        rows.append((name, f"{value:.5g} +- {1.96 * deviation:.2g}", "", unit))
    rows.append(("p2", f"above {steps.fast_pole_bound:.3g} (95 %)", "", "rad/s"))
    title = "The paper's procedure, equations (9) to (12), with R and the supply given"
    return Listing(("parameter", "the paper's way", "whole-recording fit", "unit"), rows, title)


def audit_lines(checks: Sequence[Check]) -> list[str]:
    """The audit of Table I, one paragraph for each row."""
    lines = ["Table I of the paper, checked against itself:"]
    for check in checks:
        lines.append(f"  {check.row}: printed {check.printed}; {check.follows}\n    -> {check.verdict}")
    return lines
