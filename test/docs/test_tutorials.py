"""The README and the tutorials, pasted into a shell in a clean clone: they run, and what they quote comes out."""

from __future__ import annotations

import json
import re
import runpy
import shutil

import matplotlib.image
import numpy as np
import pytest
from support.browser import WANTED
from support.documentation import ROOT, clone, pasted
from support.snippets import run

NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
BOX = re.compile(r"[│┃|\s]+")


@pytest.mark.ros
def test_the_readme_runs_as_pasted(tmp_path):
    pytest.importorskip("mujoco", minversion="3.13")
    pasted("README.md", clone(tmp_path))
    for result in ("demo/diagnosis", "throttle", "bench"):
        document = json.loads((tmp_path / "results" / result / "diagnosis.json").read_text())
        assert document["verdict"] == "missing_physics", result
    assert (tmp_path / "throttle.xml").exists()


@pytest.mark.search
def test_the_story_runs_and_says_what_comes_out(tmp_path):
    holds(pasted("docs/story.md", clone(tmp_path)))
    document = json.loads((tmp_path / "results/diagnosis/diagnosis.json").read_text())
    assert [effect["id"] for effect in document["effects"]] == ["static_friction"]
    assert document["parameters"]["armature_resistance"]["value"] == pytest.approx(4.55, rel=0.001)
    breakaway = document["effects"][0]["parameters"]["breakaway_torque"]["ci95"]
    assert breakaway[0] < 0.27 < breakaway[1]


@pytest.mark.search
def test_my_bag_ends_in_a_model_that_mujoco_runs_to_the_noise(tmp_path):
    pytest.importorskip("mujoco", minversion="3.13")
    holds(pasted("docs/my_bag.md", clone(tmp_path)))
    assert (tmp_path / "results/throttle/report.html").exists()
    if WANTED:
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


@pytest.mark.search
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


def holds(quotes):
    """Each line that a page quotes was printed since the text before."""
    assert quotes
    for text, said in quotes:
        for line in text.splitlines():
            assert any(alike(line, each) for each in said.splitlines()), f"{line!r} is not in\n{said}"


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
