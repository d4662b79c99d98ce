"""Of effects named with a confidence, how many were there: the calibration curve of blind trials.

    python benchmarks/calibration.py TRIALS [TRIALS ...] [--document]

Each `TRIALS` is the folder of a run of `pierburg prove`. `--document` writes the table into docs/proof.md.
"""

from __future__ import annotations

import argparse
import itertools
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from machine import write_section

from pierburg_ros.proof.intervals import Share
from pierburg_ros.proof.seal import SEAL, opened

EDGES = (0.0, 0.6, 0.8, 0.9, 0.99, 1.0)
"""Ranges of confidence that are counted apart; the last one holds both of its ends."""


@dataclass(frozen=True)
class Named:
    """An effect that a diagnosis names: how sure it was, whether it was there, whether all was accounted for."""

    confidence: float
    there: bool
    unexplained: bool


def named(trials: Path) -> Iterator[Named]:
    """The effects named in a run's trials; a recording's own converter is seen, not judged."""
    for seal in sorted(trials.glob(f"*/{SEAL}")):
        written = seal.parent / "diagnosis" / "diagnosis.json"
        if not written.exists():
            continue
        diagnosis = json.loads(written.read_text())
        there = {effect["id"] for effect in opened(seal.parent)["effects"]}
        for effect in diagnosis["effects"]:
            yield Named(effect["confidence"], effect["id"] in there, diagnosis["verdict"] == "unexplained")


def table(effects: Sequence[Named]) -> str:
    """The share that was there by range of confidence, where all was accounted for and where something remains."""
    lines = [
        "| confidence | mean | there, all accounted for | there, beside what remains |",
        "| --- | --- | --- | --- |",
    ]
    for low, high in itertools.pairwise(EDGES):
        inside = [each for each in effects if low <= each.confidence < high or each.confidence == high == 1.0]
        if inside:
            mean = sum(each.confidence for each in inside) / len(inside)
            shares = [_there(each for each in inside if each.unexplained == rest) for rest in (False, True)]
            lines.append(f"| {low:g} to {high:g} | {mean:.3f} | {shares[0]} | {shares[1]} |")
    return "\n".join(lines)


def _there(effects: Iterator[Named]) -> Share:
    told = [each.there for each in effects]
    return Share(sum(told), len(told))


def main() -> None:
    """Count, print the table, and write it into the page if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trials", type=Path, nargs="+")
    parser.add_argument("--document", action="store_true")
    given = parser.parse_args()
    effects = [each for trials in given.trials for each in named(trials)]
    text = f"{len(effects)} effects named.\n\n{table(effects)}"
    print(text)
    if given.document:
        write_section("calibration", text, "proof.md")


if __name__ == "__main__":
    main()
