"""Which recording belongs to which unit, and of when it is."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path, PurePosixPath
from typing import Any

from pierburg_ros.errors import InputError
from pierburg_ros.fleets.recordings.pattern import instant, matcher
from pierburg_ros.fleets.recordings.place import below, file_system, recordings_below

TABLES = (".csv", ".parquet")
COLUMNS = ("recording", "unit", "time")


@dataclass(frozen=True)
class Source:
    """A recording of a fleet: its path, whose it is, and when it was made if that is known before it is read."""

    path: str
    unit: str
    time: datetime | None = None


def sources(where: str, pattern: str | None = None) -> list[Source]:
    """The recordings of a fleet, by unit and path.

    `where` is a folder, a glob, or a table (CSV, Parquet) with the columns recording, unit and time, its paths told
    from its own folder. Without a table the `pattern` says what is unit and date in a path; without one the unit is the
    folder that a recording lies in, and the time the recording's own.
    """
    if is_table(where):
        if pattern:
            raise InputError(
                f"Found --pattern beside the table {where}, which says unit and time. Leave the pattern out."
            )
        found = list(_tabulated(where))
    else:
        base, paths = recordings_below(where)
        found = list(_patterned(base, paths, pattern) if pattern else _by_folder(base, paths))
    return sorted(found, key=lambda source: (source.unit, source.path))


def is_table(where: str) -> bool:
    """Whether a path is that of a table of recordings, and not of a folder or a glob."""
    return where.lower().endswith(TABLES) and not any(mark in where for mark in "*?[")


def _by_folder(base: str, paths: list[str]) -> Iterator[Source]:
    for path in paths:
        parent = PurePosixPath(below(base, path)).parent
        yield Source(path, str(parent) if str(parent) != "." else PurePosixPath(base).name or "fleet")


def _patterned(base: str, paths: list[str], pattern: str) -> Iterator[Source]:
    wanted, matched = matcher(pattern), False
    for path in paths:
        found = wanted.fullmatch(below(base, path))
        if found is None:
            continue
        matched, told = True, found.groupdict()
        time = instant(told["date"]) if "date" in told else None
        parent = PurePosixPath(below(base, path)).parent
        yield Source(path, told.get("unit") or str(parent), time)
    if not matched:
        raise InputError(
            f"--pattern {pattern} fits none of {len(paths)} recordings below {base}, as {below(base, paths[0])}."
            " Write it as from there."
        )


def _tabulated(where: str) -> Iterator[Source]:
    """The rows of a table of recordings."""
    folder = where.rpartition("/")[0]
    for number, row in enumerate(_rows(where), start=1):
        if missing := [name for name in COLUMNS[:2] if not row.get(name)]:
            raise InputError(f"{where}: row {number} has no {missing[0]}, expected columns recording, unit and time.")
        path = str(row["recording"])
        whole = path if path.startswith("/") or "://" in path or not folder else f"{folder}/{path}"
        yield Source(whole, str(row["unit"]), _moment(row.get("time")))


def _moment(value: Any) -> datetime | None:
    if value is None or value == "":
        return None
    if isinstance(value, datetime):
        return value if value.tzinfo else value.replace(tzinfo=timezone.utc)
    return instant(str(value))


def _rows(where: str) -> list[Mapping[str, Any]]:
    system, inner = file_system(where)
    try:
        content = Path(inner).read_bytes() if system is None else system.cat_file(inner)
        if where.lower().endswith(".parquet"):
            from pyarrow import parquet

            rows: list[Mapping[str, Any]] = parquet.read_table(io.BytesIO(content)).to_pylist()
        else:
            rows = list(csv.DictReader(io.StringIO(content.decode("utf-8-sig"))))
    except ImportError:
        raise InputError(
            f"{where} needs pyarrow, which is not installed. Install it with pip install 'pierburg_ros[fleet]'."
        ) from None
    except OSError as error:
        raise InputError(
            f"{where} cannot be read ({error.strerror or error}), expected a table of recordings."
        ) from None
    except ValueError as error:
        raise InputError(f"{where} cannot be read as a table ({str(error)[:100]}).") from None
    if not rows or not set(COLUMNS[:2]) <= set(rows[0]):
        raise InputError(
            f"{where} has {f'columns {sorted(map(str, rows[0]))}' if rows else 'no rows'}, expected recording, unit and"
            " time."
        )
    return rows
