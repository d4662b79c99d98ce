"""The two tutorials and the notebooks: run from top to bottom, and what they quote is what comes out."""

from __future__ import annotations

import json
import re
import runpy
import shutil

import matplotlib.image
import numpy as np
import pytest
from support.browser import CHROMIUM, DRIVER
from support.documentation import ROOT, blocks, commands, run_shown
from support.snippets import run

pytestmark = pytest.mark.search
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
BOX = re.compile(r"[│┃|\s]+")


def test_the_story_runs_and_says_what_comes_out(tmp_path, monkeypatch, capsys):
    follow("docs/story.md", tmp_path, monkeypatch, capsys)
    document = json.loads((tmp_path / "results/diagnosis/diagnosis.json").read_text())
    assert [effect["id"] for effect in document["effects"]] == ["static_friction"]
    assert document["parameters"]["armature_resistance"]["value"] == pytest.approx(4.55, rel=0.001)
    breakaway = document["effects"][0]["parameters"]["breakaway_torque"]["ci95"]
    assert breakaway[0] < 0.27 < breakaway[1]


def test_my_bag_ends_in_a_model_that_mujoco_runs_to_the_noise(tmp_path, monkeypatch, capsys):
    pytest.importorskip("mujoco", minversion="3.13")
    follow("docs/my_bag.md", tmp_path, monkeypatch, capsys)
    assert (tmp_path / "results/throttle/report.html").exists()
    if CHROMIUM and DRIVER:
        the_pictures_of_the_readme_can_be_taken(tmp_path / "results/throttle/report.html", tmp_path)


def the_pictures_of_the_readme_can_be_taken(report, folder):
    """Each shows much, as the kept one does, and is small enough for a first screen."""
    script = runpy.run_path(str(ROOT / "docs" / "images" / "report.py"))
    script["take"](report, folder, folder)
    for name in script["PICTURES"]:
        assert f"docs/images/{name}" in (ROOT / "README.md").read_text(encoding="utf-8")
        kept, taken = (matplotlib.image.imread(place / name) for place in (ROOT / "docs" / "images", folder))
        assert kept.shape == taken.shape
        assert np.ptp(taken, axis=(0, 1)).max() > 0.5
        assert (ROOT / "docs" / "images" / name).stat().st_size < 200 * 1024


def test_the_readme_goes_the_way_of_my_bag():
    """Its commands are those of the page, which are run above, but for comments."""
    page = [words for block in blocks("docs/my_bag.md", "sh") for words in commands(block)]
    (own,) = [block for block in blocks("README.md", "sh") if "inspect" in block.text]
    assert [words for words in commands(own) if words not in page] == []


def test_the_notebook_of_my_bag_names_what_was_concealed(tmp_path, monkeypatch):
    for name in ("throttle_bag.py", "my_actuator.yaml"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for cell in json.loads((ROOT / "examples" / "my_bag.ipynb").read_text(encoding="utf-8"))["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None
        if cell["cell_type"] == "code":
            run("".join(cell["source"]), names)
    diagnosis = names["diagnosis"]
    assert diagnosis.effects == ("input_delay",)
    assert diagnosis.model.values["input_delay.delay"] == pytest.approx(0.02, abs=2e-4)
    assert diagnosis.model.values["coulomb_friction"] == pytest.approx(0.115, rel=0.01)
    assert (tmp_path / "throttle.xml").exists()


def follow(page, folder, monkeypatch, capsys):
    """Run the blocks of a page from top to bottom; each text is what the blocks since the last one have said."""
    shutil.copytree(ROOT / "examples", folder / "examples")
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "100")
    names: dict[str, object] = {}
    said = ""
    for block in blocks(page, "sh", "python", "text"):
        if block.language == "text":
            for line in block.text.splitlines():
                assert any(alike(line, each) for each in said.splitlines()), f"{line!r} is not in\n{said}"
            said = ""
        elif block.language == "python":
            exec(block.text, names)
        else:
            for words in commands(block):
                if words[0] != "make":
                    run_shown(words)
        said += capsys.readouterr().out


def alike(line: str, other: str) -> bool:
    """Whether a line quotes another: its words in order, its numbers within 2 %; frames and spaces do not count."""
    quoted, whole = (BOX.sub(" ", text).strip() for text in (line, other))
    if NUMBER.sub("#", quoted) not in NUMBER.sub("#", whole):
        return False
    before = NUMBER.sub("#", whole).index(NUMBER.sub("#", quoted))
    first = NUMBER.sub("#", whole)[:before].count("#")
    found = [float(number) for number in NUMBER.findall(whole)][first:]
    wanted = [float(number) for number in NUMBER.findall(quoted)]
    return wanted == pytest.approx(found[: len(wanted)], rel=0.02)
