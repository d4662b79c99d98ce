"""Writes the pages of the reference from the code: `python docs/reference/write.py`; a test compares them."""

from __future__ import annotations

import sys
from pathlib import Path

FOLDER = Path(__file__).parent
sys.path[:0] = [str(FOLDER.parents[1]), str(FOLDER.parent)]

from reference import commands, document, fleet_tables, parameters, topics  # noqa: E402

WRITTEN = {
    "commands.md": commands.page,
    "diagnosis_json.md": document.page,
    "fleet_tables.md": fleet_tables.page,
    "parameters.md": parameters.page,
    "topics.md": topics.page,
}
MARK = "<!-- written by python docs/reference/write.py: begin -->\n"


def page(name: str) -> str:
    """A page: its head as it is kept, and behind the mark what the code says."""
    head = (FOLDER / name).read_text(encoding="utf-8").split(MARK)[0]
    return f"{head}{MARK}\n{WRITTEN[name]()}"


if __name__ == "__main__":
    for name in WRITTEN:
        (FOLDER / name).write_text(page(name), encoding="utf-8")
