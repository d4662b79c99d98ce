"""How often names of a confidence are right: `python benchmarks/calibration.py DIAGNOSES TRUTHS [TRUTHS...]`.

DIAGNOSES has a folder for each recording with its diagnosis.json, a folder TRUTHS one of the same name with its
truth.json, which lists the concealed effects. A prefix up to the first "t-" does not count. Writes its section of
docs/developers/measurements.md; --no-write only prints.
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

from machine import write_section
from stated import table

BOUNDS = (0.0, 0.5, 0.9, 0.99, 1.0)
"""Between which confidences are counted together; the last group holds 1 itself."""


def named(diagnoses: Path, truths: list[Path]) -> Iterator[tuple[float, bool]]:
    """Confidence of each effect that was named, and whether it was concealed."""
    for path in sorted(diagnoses.glob("*/diagnosis.json")):
        name = path.parent.name.removeprefix("t-")
        for truth in (folder / name / "truth.json" for folder in truths):
            if truth.exists():
                concealed = {effect["id"] for effect in json.loads(truth.read_text())["effects"]}
                for effect in json.loads(path.read_text())["effects"]:
                    yield effect["confidence"], effect["id"] in concealed


def main() -> None:
    """Count, print, write."""
    parser = argparse.ArgumentParser()
    parser.add_argument("diagnoses", type=Path)
    parser.add_argument("truths", type=Path, nargs="+")
    parser.add_argument("--no-write", action="store_true")
    given = parser.parse_args()
    names = list(named(given.diagnoses, given.truths))
    rows = table(names, BOUNDS, ("confidence", "names given", "right, by their confidences"))
    text = f"{rows}\n\nn = {len(names)} names. Made by `python benchmarks/calibration.py`."
    print(text)
    if not given.no_write:
        write_section("calibration", text)


if __name__ == "__main__":
    main()
