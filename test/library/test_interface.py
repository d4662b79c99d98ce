"""`import pierburg_ros as pr`: what it offers, and that it costs and touches nothing."""

import ast
import inspect
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pierburg_ros as pr

SOURCE = Path(pr.__file__)
IMPORT = """
import json, sys, time
watched = ("open", "os.", "shutil.", "subprocess.Popen", "tempfile.")
seen = []
def audit(name, arguments):
    if name.startswith(watched) and not name.startswith(("os.listdir", "os.scandir", "os.putenv")):
        seen.append([name, *map(str, arguments)])
sys.addaudithook(audit)
began = time.perf_counter()
import pierburg_ros
took = time.perf_counter() - began
loaded = [name for name in ("numba", "numpy", "scipy", "plotly", "matplotlib") if name in sys.modules]
print(json.dumps({"seen": seen, "loaded": loaded, "took": took}))
"""
FUNCTIONS = ("read", "simulate", "compare", "identify", "diagnose")


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    """What a fresh process does while it imports the package."""
    home = tmp_path_factory.mktemp("home")
    environment = {**os.environ, "XDG_CACHE_HOME": str(home), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([sys.executable, "-c", IMPORT], env=environment, capture_output=True, text=True, check=True)
    assert not done.stderr and not any(home.iterdir())
    return json.loads(done.stdout)


def test_importing_it_opens_sources_alone_and_only_to_read(imported, record_testsuite_property):
    record_testsuite_property("import time [s]", imported["took"])
    for name, path, mode, *_ in imported["seen"]:
        assert name == "open" and Path(path).suffix in (".py", ".pyc") and mode in ("r", "rb", "None")


def test_importing_it_loads_no_library(imported):
    assert imported["loaded"] == []


def test_everything_it_names_is_there_and_listed():
    assert set(pr.__all__) <= set(dir(pr))
    for name in pr.__all__:
        assert getattr(pr, name).__doc__


def test_it_lists_what_it_offers_and_nothing_of_its_own_making():
    assert [name for name in dir(pr) if not name.startswith("__")] == pr.__all__


def test_what_it_names_and_what_type_checkers_see_are_the_same():
    block = next(node for node in ast.parse(SOURCE.read_text()).body if isinstance(node, ast.If))
    seen = {alias.name: node.module for node in block.body for alias in node.names}
    assert {name: f"pierburg_ros.{home}" for name, home in pr._HOME.items()} == seen
    assert sorted(seen) == pr.__all__


def test_a_name_that_does_not_exist_is_an_ordinary_attribute_error():
    with pytest.raises(AttributeError, match=r"module 'pierburg_ros' has no attribute 'analyse'"):
        _ = pr.analyse


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda path: pr.read(path, time="wall"), "`time` found 'wall', expected one of stamp, clock, publish, log"),
        (lambda path: pr.read(path, topics={"volume": "v"}), "`topics` found the unknown signal volume"),
        (lambda path: pr.read(path, topics={"duty": "pwm"}), "has no column pwm"),
        (lambda path: pr.compare(path, pr.Model.nominal("xl330")), "Choose another `actuator`."),
    ],
)
def test_what_cannot_be_used_is_told_by_argument(tmp_path, call, said):
    path = tmp_path / "run.csv"
    path.write_text("time,duty,hall_voltage\n0,0,1\n1,0,1\n2,0,1\n")
    with pytest.raises(pr.InputError) as refused:
        call(path)
    assert said in str(refused.value) and "--" not in str(refused.value)


class Unlike:
    """What is neither a path, nor a recording, a model or names."""


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda path: pr.read(None), "Found something of type NoneType, expected a recording, or the path of one"),
        (lambda path: pr.read(Unlike()), "Found something of type Unlike"),
        (lambda path: pr.read(path, actuator="valve"), "There is no actuator valve"),
        (lambda path: pr.read(path, exact="duties"), "found 'duties', expected one of"),
        (lambda path: pr.compare(Unlike(), pr.Model.nominal()), "expected a recording, or the path of one"),
        (lambda path: pr.compare(path, Unlike()), "type Unlike, expected a model, or the path of its file"),
        (lambda path: pr.identify(None), "type NoneType, expected a recording"),
        (lambda path: pr.identify([path, None]), "type NoneType, expected a recording"),
        (lambda path: pr.identify(path, fixed="torque"), "There is no parameter torque in"),
        (lambda path: pr.identify(path, jobs="2"), "jobs is '2'; expected 1 or more, a whole number"),
        (lambda path: pr.identify(path, jobs=1.5), "jobs is 1.5; expected 1 or more, a whole number"),
        (lambda path: pr.simulate(None, duty=path), "Found no model, expected one or the path of its file"),
        (lambda path: pr.Model.nominal(None), "type NoneType, expected the name of an actuator"),
        (lambda path: pr.Model.nominal().with_values(None), "Found values as NoneType, expected a dict"),
        (lambda path: pr.Model.nominal().with_values(["gear_ratio"]), "Found values as list, expected a dict"),
        (lambda path: pr.Model.nominal().write(None), "type NoneType, expected the path of a file"),
    ],
)
def test_what_is_of_another_kind_is_told_in_one_line(moving, call, said):
    with pytest.raises(pr.InputError) as refused:
        call(moving)
    assert said in str(refused.value) and "\n" not in str(refused.value)


@pytest.fixture(scope="module")
def moving(tmp_path_factory):
    """The table of a valve that moves."""
    time = np.arange(0.0, 6.0, 0.004)
    made = pr.simulate(pr.Model.nominal(), duty=0.3 * (time % 2.0 > 1.0), time=time)
    path = tmp_path_factory.mktemp("moving") / "run.csv"
    made.table().to_csv(path, index=False)
    return path


def test_an_actuator_of_a_recording_may_be_named(moving):
    assert pr.read(moving, actuator="pierburg").quantity == "hall_voltage"


def test_a_command_in_a_message_keeps_its_options(tmp_path):
    (tmp_path / "run.csv").write_text("time,duty\n0,0\n")
    with pytest.raises(pr.InputError, match=rf"'pierburg inspect {tmp_path.name} --write-signals FILE' writes one"):
        pr.read(tmp_path)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_is_typed_and_documents_each_argument_and_an_example(name):
    function = getattr(pr, name)
    signature = inspect.signature(function)
    assert all(parameter.annotation is not inspect.Parameter.empty for parameter in signature.parameters.values())
    assert signature.return_annotation is not inspect.Signature.empty
    text = inspect.getdoc(function)
    assert not [parameter for parameter in signature.parameters if parameter not in text]
    assert "InputError" in text and f"pr.{name}(" in text


def test_the_module_is_the_command():
    done = subprocess.run([sys.executable, "-m", "pierburg_ros", "--help"], capture_output=True, text=True, check=True)
    assert "Usage: pierburg" in done.stdout
