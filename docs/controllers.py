"""The table of controllers in docs/control.md, from `pierburg tune --compare`: `python docs/controllers.py`."""

from __future__ import annotations

from pathlib import Path

DATA = Path(__file__).parent / "developers/data/controllers.txt"
DOCUMENT = Path(__file__).parent / "control.md"
BEGIN, END = "<!-- controllers: written by docs/controllers.py -->", "<!-- end of controllers -->"


def table() -> str:
    """The table of goals, and the row of each controller over all plants."""
    text = DATA.read_text(encoding="utf-8")
    goals = text[text.index("### Goals") :].split("###")[1].partition("\n")[2].strip()
    worst = [row.split(" | ") for row in text.splitlines() if row.startswith("| **all plants, worst**")]
    met = ", ".join(f"{row[1]} {row[2]}" for row in worst)
    return f"{goals}\n\nGoals met over all plants of the set: {met}."


def written(document: str) -> str:
    """`document` with the table between its marks."""
    before, _, rest = document.partition(BEGIN)
    return f"{before}{BEGIN}\n\n{table()}\n\n{END}{rest.partition(END)[2]}"


if __name__ == "__main__":
    DOCUMENT.write_text(written(DOCUMENT.read_text(encoding="utf-8")), encoding="utf-8")
