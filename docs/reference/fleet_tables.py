"""The columns of the tables that `pierburg fleet` writes, as `fleets/table.py` declares them."""

from __future__ import annotations

from pierburg_ros.fleets.table import COLUMNS
from reference.markdown import code, table


def page() -> str:
    """A section for each table."""
    return "\n".join(_section(name, columns) for name, columns in COLUMNS.items())


def _section(name: str, columns: dict[str, tuple[str, str]]) -> str:
    rows = ((code(column), kind, meaning) for column, (kind, meaning) in columns.items())
    return f"## {name}.parquet\n\n{table(('column', 'type', 'meaning'), rows)}"
