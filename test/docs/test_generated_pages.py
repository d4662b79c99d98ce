"""Pages that are written by the code say what the code says today."""

import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import pierburg_ros as pr
from pierburg_ros.effects.page import page

DOCS = Path(__file__).parents[2] / "docs"
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?")


def test_the_page_of_effects_is_written_from_the_declarations():
    kept = (DOCS / "reference" / "effects.md").read_text(encoding="utf-8")
    assert kept == page(), "run python -m pierburg_ros.effects.page"


@pytest.mark.parametrize("name", ["commands.md", "diagnosis_json.md", "fleet_tables.md", "parameters.md", "topics.md"])
def test_the_reference_is_written_from_the_code(name):
    write = runpy.run_path(str(DOCS / "reference" / "write.py"))
    assert (DOCS / "reference" / name).read_text(encoding="utf-8") == write["page"](name), (
        "run python docs/reference/write.py"
    )
    assert name in write["WRITTEN"]


def test_the_reference_of_commands_has_defaults_in_words_and_negative_forms():
    text = (DOCS / "reference" / "commands.md").read_text(encoding="utf-8")
    assert "| `--output`, `-o` | default results/demo |" in text
    assert "| `--predictor`, `--no-predictor` |" in text


def test_the_python_reference_has_every_public_name():
    text = (DOCS / "reference" / "python.md").read_text(encoding="utf-8")
    assert set(re.findall(r":: pierburg_ros\.(\w+)", text)) == set(pr.__all__)


@pytest.fixture(scope="module")
def paper(tmp_path_factory):
    """The folder of the paper's figures, drawn anew."""
    folder = tmp_path_factory.mktemp("docs") / "paper"
    shutil.copytree(DOCS / "paper", folder, ignore=shutil.ignore_patterns("*.png", "README.md", "__pycache__"))
    subprocess.run([sys.executable, folder / "figures.py"], check=True)
    return folder


def test_the_page_of_the_paper_says_what_the_simulator_gives_today(paper):
    """Its words to the letter, its numbers to a part in a hundred: another processor rounds otherwise."""
    kept, written = ((folder / "README.md").read_text(encoding="utf-8") for folder in (DOCS / "paper", paper))
    assert NUMBER.split(kept) == NUMBER.split(written), "run python docs/paper/figures.py"
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (kept, written)]
    assert numbers[0] == pytest.approx(numbers[1], rel=0.01, abs=0.011), "run python docs/paper/figures.py"


def test_every_figure_of_the_page_is_drawn_and_kept(paper):
    named = set(re.findall(r"\((figure_\d+\.png)\)", (paper / "README.md").read_text(encoding="utf-8")))
    for folder in (DOCS / "paper", paper):
        assert {path.name for path in folder.glob("*.png")} == named
