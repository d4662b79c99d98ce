"""The results of a fleet as tables: their columns with units, and Parquet files of them.

`recordings.parquet` has a row for each recording, `findings.parquet` for each finding of each recording,
`ageing.parquet` for each quantity of each unit. docs/reference/fleet_tables.md, written from here, lists them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pierburg_ros.errors import InputError
from pierburg_ros.fleets.ageing.ageing import Ageing
from pierburg_ros.fleets.ageing.course import moment
from pierburg_ros.fleets.run import Examined
from pierburg_ros.fleets.store import RECORDINGS

if TYPE_CHECKING:
    import pyarrow

COLUMNS: dict[str, dict[str, tuple[str, str]]] = {
    "recordings": {
        "recording": ("string", "path as it was given or found"),
        "unit": ("string", "whose recording it is"),
        "time": ("timestamp", "when it was made, UTC"),
        "problem": ("string", "why it could not be used; null where it could"),
        "verdict": ("string", "consistent, parameter_drift, missing_physics or unexplained"),
        "effects": ("strings", "effects that the diagnosis names"),
        "drifted": ("strings", "base parameters that it changes"),
        "faults": ("strings", "signals that are not what they are read as, or tell nothing; then nothing is concluded"),
        "stopped": ("bool", "whether time was over before all was tried"),
        "summary": ("string", "one paragraph that a technician can read"),
        "duration": ("double", "[s]"),
        "samples": ("int64", "measured samples"),
        "temperature": ("double", "mean of the recorded temperature [degC]"),
        "supply_voltage": ("double", "mean of the recorded supply [V]"),
        "noise_floor": ("double", "noise of the sensor, measured unit"),
        "nominal_rmse": ("double", "training error of the actuator as described, measured unit"),
        "final_rmse": ("double", "training error of the corrected model, measured unit"),
        "report": ("string", "the recording's report, from the folder of the table"),
        "key": ("string", "of the recording, the settings and the version: what has it is not done again"),
        "processor_time": ("double", "that the diagnosis took [s]"),
    },
    "findings": {
        "recording": ("string", "as in recordings"),
        "unit": ("string", "whose recording it is"),
        "time": ("timestamp", "when it was made, UTC"),
        "kind": (
            "string",
            "parameter, effect or ruled_out: what the diagnosis says; measured: what the fleet's model fits",
        ),
        "quantity": ("string", "armature_resistance, or effect.parameter"),
        "value": ("double", "in in_unit; null where only a limit is known"),
        "low": ("double", "lower end of the 95 % interval, or what is excluded below, in in_unit"),
        "high": ("double", "upper end of the 95 % interval, or what is excluded above, in in_unit"),
        "in_unit": ("string", "unit of the numbers"),
        "identifiable": ("bool", "whether the recording determines it"),
        "confidence": ("double", "of an effect, 0 to 1"),
    },
    "ageing": {
        "unit": ("string", "whose quantity it is"),
        "quantity": ("string", "name as in findings"),
        "in_unit": ("string", "unit of the numbers"),
        "recordings": ("int64", "recordings that say something"),
        "limited": ("int64", "of them, those that only say what it is not above"),
        "begin": ("timestamp", "of the course, UTC"),
        "end": ("timestamp", "of the course, UTC"),
        "level": ("double", "value at the end of the course, by its line"),
        "level_deviation": ("double", "standard deviation of that"),
        "scatter": ("double", "standard deviation between recordings beside the stated intervals"),
        "slope": ("double", "change a day"),
        "slope_low": ("double", "lower end of its 95 % interval"),
        "slope_high": ("double", "upper end"),
        "trend_chance": ("double", "how often no change shows as much"),
        "trend_rate": ("double", "false discovery rate at which the trend is believed; changes below 0.05"),
        "changes": ("bool", "whether it is believed"),
        "step_after": ("timestamp", "last recording before the clearest step, UTC"),
        "step_before": ("timestamp", "first recording after it, UTC"),
        "step_first": ("timestamp", "earliest moment of the step, 95 %"),
        "step_last": ("timestamp", "latest moment"),
        "step_size": ("double", "of the step"),
        "step_low": ("double", "lower end of its 95 % interval"),
        "step_high": ("double", "upper end"),
        "step_rate": ("double", "false discovery rate at which the step is believed"),
        "stepped": ("bool", "whether it is believed"),
        "limit": ("double", "that was stated"),
        "reached": ("bool", "whether it is beyond the limit"),
        "limit_time": ("timestamp", "when the limit is reached, UTC"),
        "limit_first": ("timestamp", "earliest, 95 %"),
        "limit_last": ("timestamp", "latest, 95 %; null where it may never be"),
        "away": ("double", "deviations from the middle of the other units"),
        "away_rate": ("double", "false discovery rate at which it differs"),
        "differs": ("bool", "whether it is believed to differ"),
    },
}
"""Type and meaning of every column, by table."""
Row = dict[str, Any]


def recording_rows(recordings: Iterable[Examined]) -> list[Row]:
    """The rows of `recordings`."""
    rows = []
    for each in recordings:
        findings = each.result.get("findings", [])
        effects = dict.fromkeys(f["name"].partition(".")[0] for f in findings if f["kind"] == "effect")
        own = {name: each.result.get(name) for name in COLUMNS["recordings"]}
        rows.append(
            {
                **own,
                "recording": each.source.path,
                "unit": each.source.unit,
                "time": moment(each),
                "effects": list(effects),
                "drifted": [f["name"] for f in findings if f["kind"] == "parameter"],
                "faults": each.result.get("faults", []),
                "report": None if each.problem else f"{RECORDINGS}/{each.key}/report.html",
                "key": each.key or None,
            }
        )
    return rows


def finding_rows(recordings: Iterable[Examined], units: dict[str, str]) -> list[Row]:
    """The rows of `findings`; `units` by dotted name."""
    rows = []
    for each in recordings:
        same = {"recording": each.source.path, "unit": each.source.unit, "time": moment(each)}
        for finding in each.result.get("findings", []):
            numbers = {name: finding[name] for name in ("kind", "value", "low", "high", "identifiable", "confidence")}
            rows.append({**same, **numbers, "quantity": finding["name"], "in_unit": finding["unit"]})
        for name, found in each.measured.items():
            reach = 1.96 * found["deviation"] if found["determined"] else None
            ends = (None, None) if reach is None else (found["value"] - reach, found["value"] + reach)
            numbers = {"kind": "measured", "value": found["value"], "low": ends[0], "high": ends[1]}
            rows.append(
                {
                    **same,
                    **numbers,
                    "quantity": name,
                    "in_unit": units[name],
                    "identifiable": found["determined"],
                    "confidence": None,
                }
            )
    return rows


def ageing_rows(known: Iterable[Ageing]) -> list[Row]:
    """The rows of `ageing`."""
    return [_ageing_row(each) for each in known]


def _ageing_row(each: Ageing) -> Row:
    course, line, step, forecast = each.course, each.line, each.step, each.forecast
    level, deviation = each.level
    ends = line.interval if line else (None, None)
    row: Row = {
        "unit": course.unit_name,
        "quantity": course.quantity,
        "in_unit": course.unit,
        "recordings": course.size,
        "limited": int(course.limited.sum()),
        "begin": instant(float(course.time[0])),
        "end": instant(float(course.time[-1])),
        "level": level,
        "level_deviation": deviation,
        "scatter": line and line.found.scatter,
        "slope": line and line.slope,
        "slope_low": ends[0],
        "slope_high": ends[1],
        "trend_chance": line and line.chance,
        "trend_rate": each.trend_rate,
        "changes": each.changes,
        "step_rate": each.step_rate,
        "stepped": each.stepped,
        "away": each.away,
        "away_rate": each.away_rate,
        "differs": each.differs,
    }
    if step is not None:
        names = ("after", "before", "first", "last")
        row |= {f"step_{name}": instant(getattr(step, name)) for name in names}
        row |= {"step_size": step.size, "step_low": step.interval[0], "step_high": step.interval[1]}
    if forecast is not None:
        row |= {"limit": forecast.limit, "reached": forecast.reached, "limit_time": instant(forecast.time)}
        row |= {"limit_first": instant(forecast.first), "limit_last": instant(forecast.last)}
    return {name: row.get(name) for name in COLUMNS["ageing"]}


def instant(day: float | None) -> datetime | None:
    """A time [days since 1970] as a moment; None where there is none within ten thousand years."""
    if day is None or not math.isfinite(day) or abs(day) > 2.9e6:
        return None
    return datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(days=day)


def schema(name: str) -> pyarrow.Schema:
    """The columns of a table as Parquet keeps them, each with its meaning."""
    import pyarrow

    types = {
        "string": pyarrow.string(),
        "strings": pyarrow.list_(pyarrow.string()),
        "timestamp": pyarrow.timestamp("ms", tz="UTC"),
        "double": pyarrow.float64(),
        "int64": pyarrow.int64(),
        "bool": pyarrow.bool_(),
    }
    return pyarrow.schema(
        pyarrow.field(column, types[kind], metadata={"meaning": meaning})
        for column, (kind, meaning) in COLUMNS[name].items()
    )


def require_parquet() -> None:
    """Raise InputError with what to install where Parquet cannot be written."""
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise InputError(
            "The tables of a fleet need pyarrow, which is not installed. Install it with pip install"
            " 'pierburg_ros[fleet]'."
        ) from None


def write_parquet(path: Path, name: str, rows: Sequence[Row]) -> None:
    """Write a table."""
    import pyarrow
    from pyarrow import parquet

    parquet.write_table(pyarrow.Table.from_pylist(list(rows), schema=schema(name)), path)
