"""An identification and the audit as tables for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.table import Table

from pierburg_ros.identification.identify import Identification, unit_of
from pierburg_ros.identification.paper.step_response import primitive_parameters
from pierburg_ros.identification.paper.table_one import Check


def parameter_table(found: Identification) -> Table:
    """Every parameter: fitted or held, with its interval where it has one."""
    table = Table(title="Parameters, from the fit of whole recordings")
    for column in ("parameter", "value", "unit", "95 % interval"):
        table.add_column(column)
    for name, entry in found.as_mapping()["parameters"].items():
        interval = entry["ci95"]
        shown = "{:.6g} to {:.6g}".format(*interval) if interval else "held" if entry["fixed"] else "none"
        table.add_row(name, f"{entry['value']:.6g}", entry["unit"], shown)
    return table


def reasons(found: Identification) -> list[str]:
    """A sentence for each parameter that these recordings cannot tell."""
    return [f"{name}: {finding.reason}" for name, finding in found.findings.items() if not finding.identifiable]


def lump_table(found: Identification) -> Table | None:
    """The lumps of sliding motion, and D_c and D_pre; None for an actuator without a spring."""
    if found.lumps is None:
        return None
    table = Table(title="What sliding motion shows, whatever is held")
    for column in ("quantity", "value", "unit", "95 % interval"):
        table.add_column(column)
    for name, lump in found.lumps.items():
        interval = "none" if lump.ci95 is None else f"{lump.ci95[0]:.6g} to {lump.ci95[1]:.6g}"
        table.add_row(name, f"{lump.value:.6g}", lump.unit, interval)
    source = "settled angles" if found.static is not None else "the fit"
    for name, duty in (found.as_mapping()["static_characteristic"] or {}).items():
        interval = "none" if duty["ci95"] is None else "{:.6g} to {:.6g}".format(*duty["ci95"])
        table.add_row(f"{name}, from {source}", f"{duty['value']:.6g}", "1", interval)
    return table


def paper_table(found: Identification) -> Table | None:
    """The paper's procedure beside the fit; None where the recordings hold no steps from rest."""
    if found.steps is None or found.static is None:
        return None
    table = Table(title="The paper's procedure, equations (9) to (12), with R and the supply given")
    for column in ("parameter", "the paper's way", "whole-recording fit", "unit"):
        table.add_column(column)
    values = found.fitted.model.values
    for name, value in primitive_parameters(found.steps, found.static, values).items():
        table.add_row(name, f"{value:.5g}", f"{values[name]:.5g}", unit_of(found.model, name))
    steps = found.steps
    for name, value, deviation, unit in (
        ("K", steps.gain, steps.gain_deviation, "rad/V"),
        ("p1", steps.slow_pole, steps.slow_pole_deviation, "rad/s"),
    ):
        table.add_row(name, f"{value:.5g} +- {1.96 * deviation:.2g}", "", unit)
    table.add_row("p2", f"above {steps.fast_pole_bound:.3g} (95 %)", "", "rad/s")
    return table


def audit_lines(checks: Sequence[Check]) -> list[str]:
    """The audit of Table I, a paragraph a row."""
    lines = ["Table I of the paper, checked against itself:"]
    for check in checks:
        lines.append(f"  {check.row}: printed {check.printed}; {check.follows}\n    -> {check.verdict}")
    return lines
