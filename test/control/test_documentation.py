"""docs/control.md says what the code says: the plants as judged, the comparison as it is written."""

import re
from pathlib import Path

import numpy as np

from pierburg_ros.closed_loop.course import STEPS
from pierburg_ros.closed_loop.designs import DESIGNS
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.closed_loop.judgement import PLACE, SEEDS, Judgement
from pierburg_ros.closed_loop.plants import plant_set
from pierburg_ros.closed_loop.report import BEGIN, END, plants_table, report

DOCUMENT = Path(__file__).parents[2] / "docs/control.md"
CELL = re.compile(r"(?<=\| )[-+.\de]+( of (?P<goals>\d+)| \([.\d]+\)| \(missed\))?(?= \|)")


def test_the_plants_are_those_judged_today_with_their_values():
    assert plants_table(plant_set()) in DOCUMENT.read_text(encoding="utf-8")


def test_the_comparison_names_plants_steps_and_columns_as_the_report_does():
    """Written by a run of hours: its results are masked, all else is to the letter what such a run writes."""
    document = DOCUMENT.read_text(encoding="utf-8")
    kept = document[document.index(BEGIN) + len(BEGIN) : document.index(END)]
    plants, random = plant_set(), np.random.default_rng(1)
    judgements = [
        Judgement(
            name,
            design.settings(np.mean(design.bounds, axis=1)),
            plants,
            {plant: random.uniform(0.5, 1.0, (len(SEEDS), len(STEPS), len(PLACE))) for plant in plants},
        )
        for name, design in DESIGNS.items()
    ]
    assert masked(kept).strip() == masked(report(Goal(), judgements)).strip()


def masked(tables: str) -> str:
    """Tables with a mark in place of each result, but for how many goals there are; without the settings found."""
    found = tables[tables.index("### Settings found") : tables.index("### Goals")]
    return CELL.sub(lambda cell: f"# of {cell['goals']}" if cell["goals"] else "#", tables.replace(found, ""))
