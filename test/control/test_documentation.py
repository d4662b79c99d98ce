"""docs/control.md and its data say what the code says: the plants as judged, the comparison as it is written."""

import re
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.closed_loop.course import STEPS
from pierburg_ros.closed_loop.designs import DESIGNS
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.closed_loop.judgement import NOISE_SEEDS, PLACE, Judgement
from pierburg_ros.closed_loop.plants import plant_set
from pierburg_ros.closed_loop.report import BEGIN, END, plants_table, report

DOCUMENT = Path(__file__).parents[2] / "docs/control.md"
MEASUREMENTS = DOCUMENT.parent / "developers/measurements.md"
COMPARISON = DOCUMENT.parent / "developers/data/controllers.txt"
CELL = re.compile(r"(?<=\| )[-+.\de]+( of (?P<goals>\d+)| \([.\d]+\)| \(missed\))?(?= \|)")


def test_the_plants_are_those_judged_today_with_their_values():
    assert plants_table(plant_set()) in COMPARISON.read_text(encoding="utf-8")


def test_the_comparison_names_plants_steps_and_columns_as_the_report_does():
    """Written by a run of hours: its results are masked, all else is to the letter what such a run writes."""
    document = COMPARISON.read_text(encoding="utf-8")
    kept = document[document.index(BEGIN) + len(BEGIN) : document.index(END)]
    plants, random = plant_set(), np.random.default_rng(1)
    judgements = [
        Judgement(
            name,
            design.settings(np.mean(design.bounds, axis=1)),
            plants,
            {plant: random.uniform(0.5, 1.0, (len(NOISE_SEEDS), len(STEPS), len(PLACE))) for plant in plants},
        )
        for name, design in DESIGNS.items()
    ]
    assert masked(kept).strip() == masked(report(Goal(), judgements)).strip()


def masked(tables: str) -> str:
    """Tables with a mark in place of each result, but for how many goals there are; without the settings found."""
    found = tables[tables.index("### Settings found") : tables.index("### Goals")]
    return CELL.sub(lambda cell: f"# of {cell['goals']}" if cell["goals"] else "#", tables.replace(found, ""))


def script_of(name: str):
    """A script of the documentation, by its name."""
    spec = spec_from_file_location(name, DOCUMENT.parent / f"{name}.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_table_of_the_page_is_that_of_the_comparison():
    document = DOCUMENT.read_text(encoding="utf-8")
    assert document == script_of("controllers").written(document), "run python docs/controllers.py"


def test_the_corrected_loops_are_those_that_the_script_judges():
    """Its searches take minutes: plants, columns, and one row that needs no search, are held against the page."""
    script = script_of("corrected_loops")
    text = MEASUREMENTS.read_text(encoding="utf-8")
    table = text[text.index(script.BEGIN) : text.index(script.END)]
    header, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.split("\n|")[1:]]
    assert tuple(header) == script.HEADER
    assert list(dict.fromkeys(row[0] for row in rows)) == list(script.MODELS)
    name = "backlash 0.072 rad"
    task = script.task_for(script.Model.nominal().with_values(script.MODELS[name]), script.Goal(), False)
    judged = script.row(name, "as shipped", task, script.Settings())
    written = next(row for row in rows if row[:2] == [name, "as shipped"])
    for shown, now in zip(written[2:], judged[2:], strict=True):
        assert float(now) == pytest.approx(float(shown), rel=0.05, abs=0.02)
