"""Proves the ageing of fleets: a simulated fleet, diagnosed, and drawn courses.

    python benchmarks/fleet.py --output results/fleet_proof --units 40 --recordings 25

The fleet of `fleet_simulation.py` is recorded by the second formulation of the physics, diagnosed as `pierburg fleet`
does, and counted; called again it goes on. `--courses` draws courses with the scatter and the intervals that were
measured there, to count what so few diagnoses cannot: these are no diagnoses.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from fleet_simulation import AGEING, BEGIN, REPAIR, YEAR, simulate
from machine import machine, write_section

import pierburg_ros as pr
from pierburg_ros.fleets.ageing.ageing import Ageing, ageing
from pierburg_ros.fleets.ageing.course import Course
from pierburg_ros.fleets.fleet import Fleet
from pierburg_ros.proof.intervals import Share

DAY0 = BEGIN.timestamp() / 86_400.0
REPAIRED = DAY0 + YEAR * REPAIR


def main() -> None:
    """Simulate, diagnose, count, and write the section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("results/fleet_proof"))
    parser.add_argument("--units", type=int, default=40)
    parser.add_argument("--recordings", type=int, default=25)
    parser.add_argument("--courses", type=int, default=200, help="fleets of drawn courses")
    parser.add_argument("--drawn", type=int, nargs=2, default=(40, 25), help="their units and recordings")
    parser.add_argument("--budget", default="1")
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--scheduler")
    given = parser.parse_args()
    simulate(given.output, given.units, given.recordings, 1)
    found = pr.fleet(
        given.output / "recordings",
        given.output / "fleet",
        actuator=given.output / "valve.yaml",
        budget=given.budget,
        jobs=given.jobs,
        scheduler=given.scheduler,
        progress=lambda stage, done, total, _: print(f"{stage} {done} of {total}", flush=True),
    )
    truth = json.loads((given.output / "truth.json").read_text())
    text = [diagnosed(found, truth, given.budget), drawn(found, given.courses, *given.drawn)]
    write_section("proof", "\n".join(text))


def diagnosed(found: Fleet, truth: dict[str, Any], budget: str) -> str:
    """What came of the simulated fleet."""
    by_unit = {name: [each for each in found.ageing if each.course.unit_name == name] for name in truth}
    counts = counted(by_unit, truth)
    seconds = [each.result["processor_time"] for each in found.recordings if not each.problem]
    return f"""### Proof: a simulated fleet, diagnosed

{len(truth)} valves, {len(found.recordings)} recordings of 12 s at 250 Hz over a simulated year, made by the second
formulation of the physics (`benchmarks/fleet_simulation.py`):
{ways(truth)}.
Temperature (season 11 to 29 degC, and 4 K from day to day) and supply (12.6 to 14.4 V) vary and are recorded. Budget
{budget} each, processor time {np.median(seconds):.1f} s (median), {np.max(seconds):.0f} s (largest), reports
included. On {machine()}.

{table(counts)}

By unit:

| unit | hidden | believed of the hidden quantity | believed of others |
|---|---|---|---|
{unit_rows(by_unit, truth)}
"""


def ways(truth: dict[str, Any]) -> str:
    """How many age how, in words."""
    kinds = [each["kind"] + (", repaired" if each["repaired"] else "") for each in truth.values()]
    return ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))


def hidden(each: dict[str, Any]) -> str:
    """The quantity that shows how a unit ages; nothing for a steady one."""
    return AGEING[each["kind"]][0] if each["kind"] in AGEING else ""


def rate(kind: str) -> float:
    """The true change a day of the quantity that ages."""
    quantity, law = AGEING[kind]
    change = law(1.0)[quantity] - law(0.0)[quantity]
    from pierburg_ros.proof.formulation import NOMINAL

    return change * NOMINAL.get(quantity, 1.0) / YEAR


def counted(by_unit: dict[str, list[Ageing]], truth: dict[str, Any]) -> dict[str, str]:
    """The figures, with n and 95 % intervals."""
    ageing_units = [name for name, each in truth.items() if hidden(each) and not each["repaired"]]
    repaired = [name for name, each in truth.items() if each["repaired"]]
    steady = [name for name, each in truth.items() if not hidden(each)]
    own = {name: of(by_unit[name], hidden(truth[name])) for name in (*ageing_units, *repaired)}
    errors = [error for name in ageing_units for error in relative(own[name], truth[name]["kind"])]
    dates = [each.step for name in repaired if (each := own[name]) is not None and each.stepped and each.step]
    courses = [each for name in steady for each in by_unit[name]]
    held = [each for name in ageing_units if (each := own[name]) is not None and each.line is not None]
    inside = sum(
        low <= rate(truth[each.course.unit_name]["kind"]) <= high for each in held for low, high in [ends(each)]
    )
    return {
        "ageing units whose hidden quantity is believed to change": str(
            Share(
                sum(each is not None and each.changes for each in (own[name] for name in ageing_units)),
                len(ageing_units),
            )
        ),
        "ageing units of which anything is believed": str(
            Share(
                sum(any(each.changes or each.stepped for each in by_unit[name]) for name in ageing_units),
                len(ageing_units),
            )
        ),
        "steady units falsely accused of a trend or a step": str(
            Share(sum(any(each.changes or each.stepped for each in by_unit[name]) for name in steady), len(steady))
        ),
        "their courses falsely accused": str(
            Share(sum(each.changes or each.stepped for each in courses), len(courses))
        ),
        "repairs found": str(Share(len(dates), len(repaired))),
        "dates of repairs within their interval": str(
            Share(sum(step.first <= REPAIRED <= step.last for step in dates), len(dates))
        ),
        "error of the rate, median and largest": spread(errors),
        "rates within their 95 % interval": str(Share(inside, len(held))),
    }


def spread(errors: list[float]) -> str:
    """Median and largest of relative errors."""
    return f"{100 * np.median(errors):.1f} %, {100 * np.max(errors):.1f} % (n = {len(errors)})" if errors else "none"


def of(known: list[Ageing], quantity: str) -> Ageing | None:
    """What is known of one quantity."""
    return next((each for each in known if each.course.quantity == quantity), None)


def ends(each: Ageing) -> tuple[float, float]:
    """95 % interval of the change a day."""
    assert each.line is not None
    return each.line.interval


def relative(each: Ageing | None, kind: str) -> Iterator[float]:
    """The error of a rate as a share of it."""
    if each is not None and each.line is not None:
        yield abs(each.line.slope / rate(kind) - 1.0)


def unit_rows(by_unit: dict[str, list[Ageing]], truth: dict[str, Any]) -> str:
    """A row for each unit that ages, and those of the others that are accused."""
    rows = []
    for name, each in truth.items():
        own = of(by_unit[name], hidden(each))
        others = [other for other in by_unit[name] if other is not own and (other.changes or other.stepped)]
        if hidden(each) or others:
            kind = each["kind"] + (", repaired" if each["repaired"] else "")
            rows.append(f"| {name} | {kind} | {believed(own)} | {', '.join(map(short, others)) or '-'} |")
    return "\n".join(rows)


def believed(each: Ageing | None) -> str:
    """What is believed of a quantity, in words."""
    if each is None or each.line is None:
        return "no course"
    parts = [f"trend {each.line.slope * YEAR:+.3g} a year"] if each.changes else []
    if each.stepped and each.step is not None:
        parts.append(f"step {each.step.size:+.3g}, {day(each.step.first)} to {day(each.step.last)}")
    return "; ".join(parts) or f"nothing (rate {each.trend_rate:.2g})"


def short(each: Ageing) -> str:
    return f"{each.course.quantity} ({believed(each)})"


def day(time: float) -> str:
    """A day of the simulated year."""
    return f"day {time - DAY0:.0f}"


def table(figures: dict[str, str]) -> str:
    """Figures as Markdown."""
    return "\n".join(
        ["| figure | count (95 % Wilson interval) |", "|---|---|", *(f"| {k} | {v} |" for k, v in figures.items())]
    )


def drawn(found: Fleet, fleets: int, units: int, recordings: int) -> str:
    """The same questions on drawn courses, with scatter and intervals as measured."""
    steady = [each for each in found.ageing if each.line is not None and not each.course.limited.any()]
    shares = [
        each.line.found.scatter / abs(each.course.nominal) for each in steady if each.line and each.course.nominal
    ]
    stated = [
        float(np.median(each.course.deviation)) / abs(each.course.nominal) for each in steady if each.course.nominal
    ]
    scatter, deviation = float(np.median(shares)), float(np.median(stated))
    rows = []
    for between in (scatter, 0.01, 0.03):
        rows.append(one_setting(fleets, units, recordings, between, deviation))
    head = (
        "| scatter | trends found | of trends believed, false | repairs found | steps where there is none | dates held "
    )
    head += "| rates held | rate error, median |"
    return f"""### Drawn courses: the statistics alone

No diagnoses: courses of one quantity around 1, {fleets} fleets of {units} units with {recordings} recordings each, a
quarter of which change by 10 % in a year, a twentieth are set back in between, the rest are steady. Their scatter
between recordings is the median measured above, {100 * scatter:.2g} % of the nominal value, and 1 and 3 %, as a bench
may have that is less alike from day to day than a simulation; the stated deviation is the median stated one,
{100 * deviation:.2g} %. Seed 1.

{head}
|---|---|---|---|---|---|---|---|
{chr(10).join(rows)}
"""


def one_setting(fleets: int, units: int, recordings: int, scatter: float, deviation: float) -> str:
    """A row of the table of drawn courses."""
    random = np.random.default_rng(1)
    count = dict.fromkeys(
        ("ageing", "found", "believed", "false", "repaired", "dated", "held", "plain", "stepped", "inside"), 0
    )
    errors = []
    slope = 0.1 / YEAR
    for _ in range(fleets):
        courses, kinds = [], []
        for number in range(units):
            kind = (
                "ageing"
                if number < units // 4
                else "repaired"
                if number < units // 4 + max(units // 20, 1)
                else "steady"
            )
            lived = (np.arange(recordings) + random.uniform(0.1, 0.9, recordings)) / recordings
            since = np.where((kind == "repaired") & (lived >= REPAIR), lived - REPAIR, lived)
            value = 1.0 + (0.0 if kind == "steady" else 0.1) * since
            value += np.hypot(scatter, deviation) * random.standard_normal(recordings)
            nothing = np.full(recordings, np.nan)
            time = DAY0 + YEAR * lived
            plain = np.zeros(recordings, dtype=bool)
            stated = np.full(recordings, deviation)
            courses.append(Course(f"u{number}", "armature_resistance", "ohm", time, value, stated, plain, nothing, 1.0))
            kinds.append(kind)
        for kind, each in zip(kinds, ageing(courses, {}, DAY0 + YEAR), strict=True):
            count["believed"] += each.changes
            count["false"] += each.changes and kind == "steady"
            if kind == "repaired":
                count["repaired"] += 1
                if each.stepped and each.step is not None:
                    count["dated"] += 1
                    count["held"] += each.step.first <= REPAIRED <= each.step.last
            else:
                count["plain"] += 1
                count["stepped"] += each.stepped
            if kind == "ageing" and each.line is not None:
                low, high = each.line.interval
                count["ageing"] += 1
                count["found"] += each.changes
                count["inside"] += low <= slope <= high
                errors.append(abs(each.line.slope / slope - 1.0))
    pairs = [
        ("found", "ageing"),
        ("false", "believed"),
        ("dated", "repaired"),
        ("stepped", "plain"),
        ("held", "dated"),
        ("inside", "ageing"),
    ]
    cells = " | ".join(str(Share(count[a], count[b])) for a, b in pairs)
    return f"| {100 * scatter:.2g} % | {cells} | {100 * np.median(errors):.1f} % |"


if __name__ == "__main__":
    main()
