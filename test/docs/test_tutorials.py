"""The README and the tutorials, pasted into a shell in a clean clone: they run, and what they quote comes out."""

from __future__ import annotations

import json
import re
import runpy
import shutil
from typing import Any

import matplotlib.image
import numpy as np
import pytest
from support.browser import WANTED
from support.documentation import ROOT, clone, pasted
from support.snippets import run

import pierburg_ros as pr

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
        report = tmp_path / "results/throttle/report.html"
        runpy.run_path(str(ROOT / "docs" / "images" / "report.py"))["take"](report, tmp_path, tmp_path)
        as_kept(tmp_path / "report.png")


def as_kept(taken):
    """A picture of the README shows much, as the kept one does, and is small enough for a first screen."""
    kept = ROOT / "docs" / "images" / taken.name
    assert f"docs/images/{taken.name}" in (ROOT / "README.md").read_text(encoding="utf-8")
    before, now = (matplotlib.image.imread(each) for each in (kept, taken))
    assert before.shape == now.shape
    assert np.ptp(now, axis=(0, 1)).max() > 0.5
    assert kept.stat().st_size < 200 * 1024


@pytest.mark.search
def test_the_first_picture_of_the_readme_can_be_drawn(tmp_path):
    script = runpy.run_path(str(ROOT / "docs" / "images" / "first.py"))
    diagnosis = pr.diagnose(ROOT / "examples" / "bench.csv", actuator="pierburg")
    # out of a standstill the shaft needs more than while it moves, and the law says at least how much
    assert np.min(np.abs(script["breakaways"](diagnosis))) > 0.95 * 0.27
    script["drawn"](diagnosis).savefig(tmp_path / "first.png", dpi=100)
    as_kept(tmp_path / "first.png")


@pytest.mark.search
def test_the_notebook_of_a_real_joint_ends_in_a_model_that_moves_like_it_in_mujoco(tmp_path, monkeypatch):
    """The makers of the recording publish viscous friction of 1.11 N.m.s/rad."""
    pytest.importorskip("mujoco", minversion="3.13")
    shutil.copytree(ROOT / "examples" / "tx40", tmp_path / "tx40")
    monkeypatch.chdir(tmp_path)
    names = cells_run("real_joint.ipynb")
    assert names["diagnosis"].effects == ("viscous_friction",)
    estimate = names["diagnosis"].document.effects[0].parameters["coefficient"]
    assert estimate.ci95[0] < 1.11 < estimate.ci95[1]
    assert names["after"].rmse < 0.02 < 0.1 * names["before"].rmse
    assert names["errors"]["joint.xml"] < 0.02 < 0.1 * names["errors"]["described.xml"]


@pytest.mark.search
def test_the_notebook_of_my_bag_names_what_was_concealed(tmp_path, monkeypatch):
    for name in ("throttle_bag.py", "my_actuator.yaml"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    diagnosis = cells_run("my_bag.ipynb")["diagnosis"]
    assert diagnosis.effects == ("input_delay",)
    assert diagnosis.model.values["input_delay.delay"] == pytest.approx(0.02, abs=2e-4)
    assert diagnosis.model.values["coulomb_friction"] == pytest.approx(0.115, rel=0.01)
    assert (tmp_path / "throttle.xml").exists()


def cells_run(notebook):
    """The names that the cells of a notebook of the examples leave; it is kept without outputs."""
    names: dict[str, Any] = {}
    for cell in json.loads((ROOT / "examples" / notebook).read_text(encoding="utf-8"))["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None
        if cell["cell_type"] == "code":
            run("".join(cell["source"]), names)
    return names


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
