"""Every command that a page shows is run as it stands; what needs ROS or takes long is held against what it calls."""

from __future__ import annotations

import re
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from support.documentation import ROOT, blocks, commands, pages, run_shown
from typer.main import get_command

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import COMMANDS, application
from pierburg_ros.cli.run import NODES
from pierburg_ros.effects import EFFECTS
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.recording import write_simulated

sys.path.insert(0, str(ROOT / "docs"))
from reference.commands import command_of
from reference.parameters import NODES as DECLARED

LONG = {"demo", "run", "tune", "prove", "experiment", "fleet"}
"""Commands that take minutes or need ROS: what they are given is read, and no more."""
OUTSIDE = {"ros2", "rosdep", "source", "export", "for", "do", "done", "python3", "pip", "rerun"}
OUTSIDE |= {".venv/bin/pip", ".venv/bin/python"}
"""What is not ours: ROS, the shell, installers. The pages say what was tried of it."""
OWN = {"README.md", "docs/story.md", "docs/my_bag.md", "docs/description.md"}
"""Pages whose commands are run by tests of their own, which hold their output against the page."""
RERUN = find_spec("rerun") is not None
OF_ROS = {"use_sim_time"}
SHELL = {page: [words for block in blocks(page, "sh") for words in commands(block)] for page in pages()}
INLINE = sorted(
    {
        (page, words)
        for page in pages()
        if not page.startswith("docs/extending/")  # whose additions are made by tests of their own
        for words in re.findall(r"`(pierburg [a-z][^`]*)`", (ROOT / page).read_text(encoding="utf-8"))
    }
)


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    """What the pages take for granted: recordings of a valve as described, a model, a description, the examples."""
    folder = tmp_path_factory.mktemp("shown")
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copy(ROOT / "examples" / "my_actuator.yaml", folder)
    (folder / "results" / "diagnosis").mkdir(parents=True)
    shutil.copy(ROOT / "examples" / "worn_valve.yaml", folder / "results" / "diagnosis" / "model.yaml")
    shutil.copy(ROOT / "examples" / "worn_valve.yaml", folder / "model.yaml")
    time = np.arange(3000) / 250.0
    duty = np.repeat(np.random.default_rng(3).uniform(0.0, 0.35, 15), 200)
    for actuator, names in (("pierburg", ("run", "real", "other", "mine")), ("my_actuator.yaml", ("my_run",))):
        model = Model.nominal(read_actuator(actuator if actuator == "pierburg" else folder / actuator))
        for seed, name in enumerate(names):
            recorded = synthetic_recording(model, time, duty, seed=seed)
            write_simulated(folder / f"{name}.mcap", time, duty, recorded.measured)
            rows = np.column_stack([time, duty, recorded.measured])
            np.savetxt(folder / f"{name}.csv", rows, delimiter=",", header="time,duty,hall_voltage", comments="")
    (folder / "bench").mkdir()
    shutil.copy(folder / "my_run.csv", folder / "bench")
    (folder / "run.cut.mcap").write_bytes((folder / "run.mcap").read_bytes()[:-4000])
    return folder


@pytest.mark.search
@pytest.mark.parametrize("page", [page for page, shown in SHELL.items() if shown and page not in OWN])
def test_the_commands_of_a_page_run_one_after_another(page, files, tmp_path, monkeypatch):
    shutil.copytree(files, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    for words in SHELL[page]:
        if words[0] == "pierburg" and words[1] in set(COMMANDS) - LONG and (RERUN or "--rerun" not in words):
            run_shown(words)


@pytest.mark.parametrize("page", [page for page, shown in SHELL.items() if shown])
def test_what_is_not_run_is_understood(page):
    for words in SHELL[page]:
        if words[0] == "pierburg":
            understood(words)
        elif words[0] == "python":
            script = (ROOT / words[1]).read_text(encoding="utf-8")
            assert all(word in script for word in words if word.startswith("--")), words
        elif words[0] == "make":
            assert re.search(rf"^{words[1]}:", (ROOT / "Makefile").read_text(), flags=re.MULTILINE), words
        else:
            assert words[0] in OUTSIDE or page in OWN, f"{page} shows {words}, which no test runs"


@pytest.mark.parametrize(("page", "text"), INLINE)
def test_a_command_within_a_sentence_is_understood(page, text):
    understood(text.split())


def understood(words: list[str]) -> None:
    """Whether the command line has the command and the options of `words`; of a node, whether it has the parameters."""
    name, given = words[1], words[2:]
    if name.startswith("--"):
        assert name in {option for parameter in get_command(application()).params for option in parameter.opts}
        return
    command = command_of(name)
    for part in given:
        command = getattr(command, "commands", {}).get(part, command)
    options = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    for word in given:
        if name == "run":
            break
        assert not word.startswith("--") or word.split("=")[0] in options, f"{words}: {name} has no {word}"
    if name == "run" and given:
        nodes = [node for node in NODES if node in given]
        assert nodes, words
        known = {each.name for node in nodes for each in DECLARED[node]} | OF_ROS
        known |= {f"{effect.id}.{each.name}" for effect in EFFECTS for each in effect.parameters}
        assert {word.split(":=")[0] for word in given if ":=" in word} <= known, words
