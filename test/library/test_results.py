"""Results: as JSON, on disk, drawn, in tables, in a notebook."""

import copy
import json
import pickle
import re
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from html.parser import HTMLParser

import matplotlib.figure
import numpy as np
import plotly.graph_objects as go
import pytest
from support.documentation import ROOT

import pierburg_ros as pr
from pierburg_ros.cli.app import main
from pierburg_ros.library.diagnosing import one_at_a_time
from pierburg_ros.library.result import Result

RESULTS = ("simulation", "comparison", "identification")


@pytest.fixture(params=RESULTS)
def result(request) -> Result:
    return request.getfixturevalue(request.param)


def test_json_has_no_number_that_json_does_not_know(result):
    assert json.loads(result.to_json(), parse_constant=pytest.fail)["schema"] == 1


def test_figures_are_objects_of_both_libraries(result):
    assert isinstance(result.figure(), go.Figure) and result.figure().data
    assert isinstance(result.picture(), matplotlib.figure.Figure) and result.picture().axes


def test_results_recordings_and_models_print_as_one_line(result):
    for shown in (result, pr.Model.nominal(), pr.Model.nominal().actuator, *getattr(result, "recordings", ())):
        assert repr(shown).startswith(type(shown).__name__) and "\n" not in repr(shown) and len(repr(shown)) < 200


def test_a_recording_and_a_result_are_drawn_alike(simulation, comparison):
    for each in (simulation, comparison, comparison.recording, simulation.recording):
        assert isinstance(each.plot(), go.Figure)


def test_a_result_is_copied_and_pickled_with_all_its_numbers(result):
    for made in (copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
        assert made.to_json() == result.to_json() and made.rows() == result.rows()
        assert made.model == result.model


def test_a_result_and_its_recording_are_equal_to_themselves_alone(result, simulation):
    for each in (result, simulation.recording, simulation.recording.command):
        assert each == each and each != copy.deepcopy(each) and len({each, each}) == 1


def test_a_model_is_written_into_a_folder_that_is_made(tmp_path):
    pr.Model.nominal().write(tmp_path / "a" / "b" / "model.yaml")
    assert pr.Model.read(tmp_path / "a" / "b" / "model.yaml") == pr.Model.nominal()


def test_the_page_of_the_interface_lists_what_every_result_can_do():
    page = (ROOT / "docs" / "library.md").read_text(encoding="utf-8").partition("## What every result can do")[2]
    listed = {name for line in page.splitlines() if line.startswith("| `") for name in re.findall(r"(\w+)\(", line)}
    own = {name for name in vars(Result) if not name.startswith("_")} - {"rows", "title", "write_into"}
    assert listed & set(vars(Result)) == own


def test_equal_models_are_one_key():
    worn = {"armature_resistance": 4.7}
    assert len({pr.Model.nominal(), pr.Model.nominal().with_values(worn), pr.Model.nominal().with_values(worn)}) == 2


def test_progress_is_told_by_one_thread_at_a_time():
    inside, most = [], []

    def tell(what):
        inside.append(what)
        most.append(len(inside))
        time.sleep(0.001)
        inside.remove(what)

    alone = one_at_a_time(tell)
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(alone, map(str, range(40))))
    assert most == [1] * 40


def test_a_notebook_shows_the_numbers_and_the_picture(result):
    seen = []
    parser = HTMLParser()
    parser.handle_data = seen.append
    parser.handle_starttag = lambda tag, attributes: seen.append(tag)
    parser.feed(result._repr_html_())
    assert set(result.rows()) <= set(seen) and "img" in seen


def test_a_table_is_a_data_frame(simulation, comparison, identification):
    np.testing.assert_array_equal(simulation.table()["hall_voltage"], simulation.measured)
    assert list(comparison.table()) == ["time", "duty", "measured", "simulated", "residual"]
    table = identification.table().set_index("parameter")
    assert table.loc["armature_resistance", "low"] < 4.7 < table.loc["armature_resistance", "high"]
    assert table.loc["total_inertia", "fixed"]


def test_without_pandas_a_table_says_what_to_install(comparison, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"needs pandas.*pip install 'pierburg_ros\[tables\]'"):
        comparison.table()


def test_saving_writes_all_files_or_none(comparison, tmp_path, monkeypatch):
    def fails(self, folder):
        (folder / "half.json").write_text("{")
        raise OSError("no space left")

    output = tmp_path / "made" / "here"
    comparison.save(output)
    assert json.loads((output / "replay.json").read_text())["rmse"] == pytest.approx(comparison.rmse)
    monkeypatch.setattr(pr.Comparison, "write_into", fails)
    with pytest.raises(OSError, match="no space left"):
        comparison.save(tmp_path / "other")
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


def test_an_empty_path_is_refused_and_named(simulation, stiff):
    uses = (pr.read, "a recording"), (simulation.save, "the folder"), (stiff.export("json").write, "the path of a file")
    for use, wanted in (*uses, (partial(pr.fleet, "recordings"), "the folder")):
        with pytest.raises(pr.InputError, match=f"Found an empty path, expected {wanted}"):
            use("")


@pytest.fixture
def saved(simulation, stiff, tmp_path):
    """The recording and the model on disk."""
    simulation.save(tmp_path)
    stiff.write(tmp_path / "model.yaml")
    return tmp_path


@pytest.mark.parametrize(
    ("command", "result"),
    [
        (["replay", "--actuator", "pierburg"], lambda path: pr.compare(path, pr.Model.nominal())),
        (["identify", "--jobs", "1"], lambda path: pr.identify(path, jobs=1)),
    ],
    ids=["replay", "identify"],
)
def test_the_command_writes_the_files_that_the_library_saves(saved, command, result):
    recording = saved / "simulated.mcap"
    with pytest.raises(SystemExit) as ended:
        main([*command, str(recording), "--output", str(saved / "command")])
    assert ended.value.code == 0
    result(recording).save(saved / "library")
    names = {path.name for path in (saved / "library").iterdir()}
    assert names == {path.name for path in (saved / "command").iterdir()}
    for name in (name for name in names if name.endswith((".json", ".csv", ".mcap", ".yaml"))):
        assert (saved / "library" / name).read_bytes() == (saved / "command" / name).read_bytes(), name
