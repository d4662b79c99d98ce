"""`pierburg prove` from the command line: what it makes, what it prints, what it refuses."""

from dataclasses import replace

import pytest

from pierburg_ros.cli import prove
from pierburg_ros.cli.app import main
from pierburg_ros.proof import plan
from pierburg_ros.proof.concealment import draw


@pytest.fixture
def short(monkeypatch):
    """Trials of a few seconds."""
    monkeypatch.setattr(
        plan, "draw", lambda *name: replace(draw(*name), duration=4.0, holdout_duration=2.0, rate=500.0)
    )


def test_recordings_without_diagnosis(tmp_path, capsys, short):
    arguments = ["--trials", "1", "--only", "consistent", "--generate-only", "--jobs", "1"]
    with pytest.raises(SystemExit) as ending:
        main(["prove", "--output", str(tmp_path / "run"), *arguments])
    assert ending.value.code == 0
    assert (tmp_path / "run" / "trials" / "consistent-000" / "truth.json").exists()
    assert "sealed labels" in capsys.readouterr().out


def test_an_unknown_kind_is_one_line_and_status_2(tmp_path, capsys):
    with pytest.raises(SystemExit) as ending:
        main(["prove", "--output", str(tmp_path / "run"), "--only", "rust"])
    assert ending.value.code == 2
    assert capsys.readouterr().err.startswith("pierburg: found kind 'rust', expected one of")
    assert not (tmp_path / "run").exists()


def test_the_progress_says_how_the_run_stands():
    shown = []
    reporter = prove.Reporter(shown.append)
    for done, right in ((1, True), (2, False)):
        reporter(done, 3, {"right": right, "false_alarm": not right})
    assert (shown[-1].done, shown[-1].about) == (2, 3)
    assert shown[-1].best == "1 right, 1 false alarms"
