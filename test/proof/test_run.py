"""A run of trials with a stand-in for the diagnosis: blind, resumable, counted, reported."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.proof import document, plan, run, trial_run
from pierburg_ros.proof.concealment import draw
from pierburg_ros.proof.graph import NotRecorded
from pierburg_ros.version import source_version

COMMAND = (sys.executable, str(Path(__file__).parents[1] / "support" / "fake_diagnosis.py"))


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """The file in which the stand-in writes down each request."""
    path = tmp_path / "asked.txt"
    monkeypatch.setenv("ASKED", str(path))
    return path


@pytest.fixture
def short(monkeypatch):
    """Trials of a few seconds, with sources that stand still."""

    def drawn(*name):
        return replace(draw(*name), duration=6.0, holdout_duration=3.0, rate=500.0)

    monkeypatch.setattr(plan, "draw", drawn)
    monkeypatch.setattr(run, "source_version", lambda: "these")


def prove(output, counts, **options):
    return run.prove(output, plan.Plan(counts, 3), workers=1, command=COMMAND, **options)


def test_a_run_goes_on_where_it_stopped(tmp_path, asked, short):
    first = prove(tmp_path / "run", {"consistent": 1})
    again = prove(tmp_path / "run", {"consistent": 2, "sensor_lag": 1})
    assert len(asked.read_text().splitlines()) == 3
    assert [result["name"] for result in again] == ["consistent-000", "sensor_lag-000", "consistent-001"]
    assert again[0] == first[0]


def test_the_diagnosis_sees_nothing_but_the_recording(tmp_path, asked, short):
    prove(tmp_path / "run", {"sensor_lag": 1})
    assert asked.read_text() == "recording.mcap ['recording.mcap']\n"


def test_scores_follow_from_the_answers(tmp_path, asked, short):
    right, wrong = prove(tmp_path / "run", {"consistent": 1, "sensor_lag": 1})
    assert right["right"] and right["complete"] and right["unseen_ratio"] == pytest.approx(1.0, abs=0.1)
    assert not wrong["right"] and wrong["verdict"] == "consistent" and wrong["concealed"] == ["sensor_lag"]


def test_a_diagnosis_that_fails_is_a_failed_trial(tmp_path, asked, short, monkeypatch):
    monkeypatch.setenv("DIAGNOSIS", "fails")
    (result,) = prove(tmp_path / "run", {"consistent": 1})
    assert not result["right"] and result["failure"].endswith("status 1: cannot tell")


def test_results_of_other_sources_do_not_count(tmp_path, asked, short):
    prove(tmp_path / "run", {"consistent": 1})
    folder = tmp_path / "run" / "trials" / "consistent-000"
    assert trial_run.result(folder, "these") is not None
    assert trial_run.result(folder, "others") is None


def test_the_version_follows_the_sources_of_the_diagnosis_only(tmp_path):
    for part in ("diagnosis", "nodes"):
        (tmp_path / part).mkdir()
        (tmp_path / part / "a.py").write_text("one")
    versions = [source_version(tmp_path)]
    for part in ("nodes", "diagnosis"):
        (tmp_path / part / "a.py").write_text("two")
        versions.append(source_version(tmp_path))
    assert versions[0] == versions[1] != versions[2]


def test_a_tampered_truth_is_refused(tmp_path, asked, short):
    prove(tmp_path / "run", {"consistent": 1})
    folder = tmp_path / "run" / "trials" / "consistent-000"
    (folder / "truth.json").write_text("{}")
    with pytest.raises(InputError, match="not what was sealed"):
        trial_run.judge(folder)


def test_recordings_can_be_made_without_diagnosing(tmp_path, asked, short):
    assert run.prove(tmp_path / "run", plan.Plan({"sensor_lag": 1}, 3), workers=1, command=None) == []
    files = {path.name for path in (tmp_path / "run" / "trials" / "sensor_lag-000").iterdir()}
    assert files == {"train.mcap", "holdout.mcap", "truth.json", "seal.json"}
    assert not asked.exists()


def test_progress_is_reported_trial_by_trial(tmp_path, asked, short):
    seen = []
    prove(
        tmp_path / "run",
        {"consistent": 2},
        report=lambda done, total, last: seen.append((done, total, last["name"])),
    )
    assert seen == [(1, 2, "consistent-000"), (2, 2, "consistent-001")]


def test_a_trial_that_could_not_be_recorded_is_reported_and_left_out(tmp_path, asked, short, monkeypatch):
    def refuse(trial, folder):
        if trial.kind == "sensor_lag":
            raise NotRecorded("lost messages")
        return prepare(trial, folder)

    prepare = trial_run.prepare
    monkeypatch.setattr(trial_run, "prepare", refuse)
    seen = []
    results = prove(
        tmp_path / "run",
        {"consistent": 1, "sensor_lag": 1, "drift": 1},
        report=lambda done, total, last: seen.append(str(last) if isinstance(last, NotRecorded) else last["name"]),
    )
    assert sorted(seen) == ["consistent-000", "drift-000", "lost messages"]
    assert [result["name"] for result in results] == ["consistent-000", "drift-000"]


def test_after_an_interrupt_no_further_trial_is_begun(tmp_path, asked, short):
    def interrupt(done, total, last):
        raise KeyboardInterrupt

    results = prove(tmp_path / "run", {"consistent": 5}, report=interrupt)
    assert [result["name"] for result in results] == ["consistent-000"]
    assert len(asked.read_text().splitlines()) == 1


def test_a_folder_of_another_seed_is_refused(tmp_path, asked, short):
    prove(tmp_path / "run", {"consistent": 1})
    with pytest.raises(InputError, match="holds a run of seed 3, not 4"):
        run.begin(tmp_path / "run", plan.Plan({}, 4))


def test_a_file_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "run").write_text("")
    with pytest.raises(InputError, match="is a file, expected a folder"):
        run.begin(tmp_path / "run", plan.Plan({}, 3))


def test_an_unknown_kind_is_refused():
    with pytest.raises(InputError, match="found kind 'rust', expected one of viscous_friction"):
        plan.planned(3, only=["rust"])


def test_a_number_of_trials_holds_for_every_kind():
    assert plan.planned(3, 2, ["backlash", "drift"]).counts == {"backlash": 2, "drift": 2}
    assert plan.planned(3, only=["drift"]).counts["drift"] >= 20


def test_the_report_gives_n_and_intervals_and_says_when_it_was_cut_short(tmp_path, asked, short):
    results = prove(tmp_path / "run", {"consistent": 1, "sensor_lag": 1})
    done = document.Run(results, plan.Plan({"consistent": 1, "sensor_lag": 5}, 3))
    docs = tmp_path / "proof.md"
    start, end = document.marks(document.PLAIN)
    docs.write_text(f"# Proof\n\nIntroduction.\n\n{start}\nsuperseded\n{end}\n\nLimits.\n")
    document.write(done, tmp_path / "run", docs)
    text = docs.read_text()
    assert "n = 2 of 6 planned trials. The run was cut short" in text
    assert "Effect-free recordings given an effect (false alarms) | 0/1 (0 to 79 %)" in text
    assert "sensor_lag-000 | open | sensor_lag | consistent | not found" in text
    assert "superseded" not in text and text.startswith("# Proof") and text.rstrip().endswith("Limits.")
    machine = json.loads((tmp_path / "run" / "results.json").read_text())
    assert machine["n"] == 2 and machine["confusion"]["sensor_lag"] == {"consistent": 1}
