"""What pages offer to run next runs as pasted; a model that is not to be trusted says so wherever it goes."""

import html
import json
import re
import shlex
import shutil
from importlib import resources

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.library.comparing import compare
from pierburg_ros.library.output import output_folder, published
from pierburg_ros.library.reading import read
from pierburg_ros.plant import Model

MAP = """time: {column: t, unit: ms}
duty: {column: pwm, unit: percent}
hall_voltage: {column: adc, unit: mV}
"""
DESCRIBED = ("--signals", "signals.yaml", "--actuator", "mine.yaml")
NEXT = re.compile(r'<pre id="command-\d+">(.*?)</pre>')


def run(*arguments) -> None:
    with pytest.raises(SystemExit) as ended:
        main([str(each) for each in arguments])
    assert ended.value.code == 0


def write_bench(path, sign=1.0):
    """A valve of another name that opens and closes, in percent and mV, its duty reversed where the `sign` is -1."""
    time = 0.004 * np.arange(2500)
    duty = np.repeat(np.random.default_rng(3).uniform(0.0, 0.35, 10), 250)
    measured = synthetic_recording(Model.nominal(read_actuator("pierburg")), time, duty).measured
    columns = np.column_stack([1e3 * time, sign * 100.0 * duty, 1e3 * measured])
    np.savetxt(path, columns, fmt="%.9f", delimiter=",", header="t,pwm,adc", comments="")


@pytest.fixture
def bench(tmp_path, monkeypatch):
    """A folder with a bench of one's own: a recording, one with the wrong sign, a signal map, a description."""
    monkeypatch.chdir(tmp_path)
    write_bench(tmp_path / "my bench.csv")
    write_bench(tmp_path / "reversed.csv", -1.0)
    (tmp_path / "signals.yaml").write_text(MAP)
    text = (resources.files("pierburg_ros.actuators") / "pierburg.yaml").read_text(encoding="utf-8")
    (tmp_path / "mine.yaml").write_text(text.replace("name: pierburg", "name: mine"))
    return tmp_path


def next_commands(page):
    """The commands that a page offers to copy."""
    return [shlex.split(html.unescape(line)) for line in NEXT.findall(page.read_text(encoding="utf-8"))]


def test_next_commands_run_as_pasted(bench):
    run("replay", "my bench.csv", *DESCRIBED, "-o", "results/before")
    run("identify", "my bench.csv", *DESCRIBED, "-o", "results/identified")
    (diagnose,) = next_commands(bench / "results/before/replay.html")
    offered = [diagnose, *next_commands(bench / "results/identified/identification.html")]
    assert [words[1] for words in offered] == ["diagnose", "replay", "diagnose"]
    run(*diagnose[1:])
    offered = [offered[1], *next_commands(bench / "diagnosis/report.html")]
    assert [words[1] for words in offered] == ["replay", "replay", "diagnose"]
    for words in offered:
        shutil.rmtree(bench / "replayed", ignore_errors=True)
        run(*words[1:])
    assert json.loads((bench / "again/diagnosis.json").read_text())["verdict"] == "consistent"


def test_a_page_names_files_where_they_lie_when_the_run_has_ended(bench):
    with output_folder(bench / "out") as folder:
        shutil.copy(bench / "my bench.csv", folder / "run.csv")
        recording = read(folder / "run.csv", signals="signals.yaml")
        compare(recording, Model.nominal(read_actuator("pierburg"))).save(folder)
    (words,) = next_commands(bench / "out/replay.html")
    assert words[2:] == [
        *("out/run.csv", "--signals", "signals.yaml"),
        *("--model", "out/model.yaml", "--output", "diagnosis"),
    ]
    assert (bench / words[2]).exists() and (bench / words[6]).exists()
    assert "partial" not in (bench / "out/replay.html").read_text(encoding="utf-8").split("provenance")[-1]


def test_a_recording_that_a_run_writes_is_named_where_it_will_lie(bench):
    with output_folder(bench / "out") as folder, output_folder(folder / "inner") as inner:
        assert str(published(folder / "run.mcap")) == "out/run.mcap"
        assert str(published(inner / "run.mcap")) == "out/inner/run.mcap"
        assert published(bench / "run.mcap") == bench / "run.mcap"


def test_a_model_of_a_refused_diagnosis_says_so(bench, capsys):
    run("diagnose", "reversed.csv", *DESCRIBED, "-o", "refused")
    capsys.readouterr()
    said = "Not corrected: the diagnosis of reversed.csv concludes nothing, its signals are at fault."
    assert said in html.unescape((bench / "refused/report.html").read_text(encoding="utf-8"))
    run("replay", "my bench.csv", "--signals", "signals.yaml", "--model", "refused/model.yaml", "-o", "after")
    assert f"refused/model.yaml: {said}\n" in capsys.readouterr().out
    run("export", "refused/model.yaml", "--to", "mujoco", "-o", "valve.xml")
    assert capsys.readouterr().out.count(said) == 1
    run("export", "refused/model.yaml", "--to", "mujoco", "-o", "valve.xml", "--json")
    assert json.loads(capsys.readouterr().out)["notes"][0] == said


def test_without_an_output_the_results_are_below_results_and_said(bench, capsys):
    run("replay", "my bench.csv", *DESCRIBED)
    assert "Results in results/replay/my bench: " in capsys.readouterr().out
    assert (bench / "results/replay/my bench/replay.html").exists()


def test_a_refused_diagnosis_shows_no_table_without_numbers(bench, capsys):
    run("diagnose", "reversed.csv", *DESCRIBED)
    said, page = capsys.readouterr().out, bench / "results/diagnose/reversed/report.html"
    assert "Nothing is concluded" in said and "as described" not in said
    content = page.read_text(encoding="utf-8")
    assert 'id="faults"' in content and 'id="why"' not in content and 'id="parameters"' not in content
    assert not re.search(r"<(td|b|tbody)[^>]*>\s*</", content)
