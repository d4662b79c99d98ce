"""Every block of code on every page has a language, and a test that runs or reads it."""

import csv
import json
import re

import pytest
import yaml
from support.documentation import ROOT, blocks, pages

from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.recording.signal_map.map_file import read_signal_map
from pierburg_ros.recording.signals import SIGNALS

LANGUAGES = {"sh", "console", "text", "python", "yaml", "csv", "json", "{eval-rst}"}
RUN = {
    "README.md": "test/docs/test_tutorials.py",
    "docs/fleet.md": "test/fleets/test_fleet.py",
    "docs/library.md": "test/library/test_documentation.py",
    "docs/my_bag.md": "test/docs/test_tutorials.py",
    "docs/simulator.md": "test/export/test_pages.py",
    "docs/extending.md": "test/recording/formats/test_extending.py",
    "docs/extending/actuator.md": "test/test_extending.py",
    "docs/extending/diagnosis.md": "test/test_extending.py",
    "docs/extending/effect.md": "test/test_contributing.py",
    "docs/extending/node.md": "test/nodes/test_extending.py",
}
"""Pages with Python, and the test that runs it."""


def test_a_block_of_code_says_its_language():
    for page in pages():
        assert {block.language for block in blocks(page)} <= LANGUAGES, page


def test_python_is_shown_where_a_test_runs_it():
    assert {page for page in pages() if blocks(page, "python")} == set(RUN)
    for page, test in RUN.items():
        assert page.rsplit("/", 1)[-1] in (ROOT / test).read_text(encoding="utf-8"), f"{test} does not read {page}"


@pytest.mark.parametrize("page", [page for page in pages() if blocks(page, "yaml", "json", "csv")])
def test_data_can_be_read(page, tmp_path):
    for block in blocks(page, "yaml", "json", "csv"):
        if block.language == "json":
            assert isinstance(json.loads(block.text), dict)
        elif block.language == "yaml":
            (tmp_path / "shown.yaml").write_text(block.text)
            is_map = block.text.split(":")[0] in SIGNALS
            assert read_signal_map(tmp_path / "shown.yaml") if is_map else yaml.safe_load(block.text)
        else:
            assert len({len(row) for row in csv.reader(block.text.splitlines(), delimiter=";")}) == 1


def test_the_contract_shows_fields_that_the_document_has():
    """Section 5 of docs/contract.md."""
    diagnosis, _ = (json.loads(block.text) for block in blocks("docs/contract.md", "json"))
    assert set(diagnosis) <= {field.alias or name for name, field in Diagnosis.model_fields.items()}


@pytest.mark.parametrize("page", pages())
def test_a_table_has_a_head_and_no_gap(page):
    """Rows behind an empty line are shown as they stand, bars and all."""
    lines = ["", *re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.DOTALL).splitlines()]
    for before, line, after in zip(lines, lines[1:], lines[2:], strict=False):
        if line.startswith("|") and not before.startswith("|"):
            assert set(after) <= set("|-: "), f"{page}: {line}"


def test_links_between_pages_lead_somewhere():
    """Also those that the site leaves to GitHub: folders, sources, examples."""
    for page in pages():
        text = re.sub(r"```.*?```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.DOTALL)
        for target in re.findall(r"\]\((?!https?:)([^)#\s]+)(?:#[^)]*)?\)", text):
            assert ((ROOT / page).parent / target).exists(), f"{page} links to {target}"
