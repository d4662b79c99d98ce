"""The layouts in the repository: of the form that the viewers load, and every path in them is in our files."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from support.reports import result, thinned

import pierburg_ros
from pierburg_ros.library.overlays import of_diagnosis
from pierburg_ros.recording import Channel, Recording, write_simulated
from pierburg_ros.viewers.mcap_overlay import write_mcap

FOLDER = Path(__file__).parents[2] / "layouts"
FOXGLOVE = sorted(FOLDER.glob("*.json"))
PLOTJUGGLER = sorted(FOLDER.glob("*.xml"))


def script(name: str):
    """A script of the folder as a module."""
    specification = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, Path]:
    """A replay.mcap and a diagnosis.mcap as the package writes them."""
    folder = tmp_path_factory.mktemp("files")
    time = 0.002 * np.arange(500)
    write_simulated(folder / "run.mcap", time, np.zeros(time.size), np.full(time.size, 0.42))
    pierburg_ros.compare(folder / "run.mcap", pierburg_ros.Model.nominal("pierburg")).save(folder)
    found = thinned(result())
    view = found.exhibits.views[0]
    recording = Recording("run", "hall_voltage", view.time, view.measured, Channel([0.0], [0.0]))
    write_mcap(folder / "diagnosis.mcap", of_diagnosis(found, [recording])[0])
    return {"replay": folder / "replay.mcap", "diagnosis": folder / "diagnosis.mcap"}


def test_the_layouts_are_those_that_their_script_writes():
    assert {path.name: path.read_text() for path in (*FOXGLOVE, *PLOTJUGGLER)} == script("write_layouts").texts()


@pytest.mark.parametrize("kind", ["replay", "diagnosis"])
def test_every_path_is_in_the_file_that_a_layout_is_for(files, kind):
    check = script("check_layouts")
    for layout in (FOLDER / f"foxglove_{kind}.json", FOLDER / f"plotjuggler_{kind}.xml"):
        assert len(check.asked(layout)) >= 5
        assert check.missing(layout, files[kind]) == []


def test_the_check_names_each_path_that_a_recording_lacks(files):
    command = [sys.executable, FOLDER / "check_layouts.py", files["replay"], FOLDER / "plotjuggler_diagnosis.xml"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1
    assert "plotjuggler_diagnosis.xml: replay.mcap has no /diagnosis/corrected/data\n" in done.stdout


@pytest.mark.parametrize("path", FOXGLOVE, ids=lambda path: path.stem)
def test_a_layout_of_foxglove_shows_each_of_its_panels_once(path):
    layout = json.loads(path.read_text())
    assert set(layout) == {"configById", "globalVariables", "userNodes", "playbackConfig", "layout"}
    shown: list[str] = []

    def walk(node) -> None:
        if isinstance(node, str):
            shown.append(node)
        else:
            assert set(node) == {"direction", "first", "second", "splitPercentage"}
            assert node["direction"] in ("row", "column") and 0 < node["splitPercentage"] < 100
            walk(node["first"])
            walk(node["second"])

    walk(layout["layout"])
    assert sorted(shown) == sorted(layout["configById"])
    assert {panel.split("!")[0] for panel in shown} <= {"Plot", "RosOut", "DiagnosticSummary"}


@pytest.mark.parametrize("path", PLOTJUGGLER, ids=lambda path: path.stem)
def test_a_layout_of_plotjuggler_has_the_elements_that_it_reads(path):
    root = ElementTree.parse(path).getroot()
    (window,) = root.findall("tabbed_widget")
    assert window.attrib == {"name": "Main Window", "parent": "main_window"}
    (splitter,) = window.findall("Tab/Container/DockSplitter")
    areas = splitter.findall("DockArea")
    assert splitter.attrib["orientation"] == "-" and int(splitter.attrib["count"]) == len(areas)
    sizes = [float(size) for size in splitter.attrib["sizes"].split(";")]
    assert len(sizes) == len(areas) and sum(sizes) == pytest.approx(1.0, abs=1e-5)
    for area in areas:
        (plot,) = area.findall("plot")
        assert plot.attrib["mode"] == "TimeSeries" and plot.findall("curve")
    assert window.find("currentTabIndex").attrib == {"index": "0"}
