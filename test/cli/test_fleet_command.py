"""`pierburg fleet` and `pierburg tune` on a cluster: options, and what is refused before anything is begun."""

import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.cli.fleet import limits_of
from pierburg_ros.cli.tune import Effort, tuned_there
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.errors import InputError


def test_limits_are_told_by_name():
    assert limits_of(["armature_resistance=5.0", "backlash.gap = 0.05"]) == {
        "armature_resistance": 5.0,
        "backlash.gap": 0.05,
    }
    with pytest.raises(InputError, match="expected NAME=VALUE"):
        limits_of(["armature_resistance"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["none"], "none is no folder"),
        (["none", "--limit", "resistance=5"], "--limit found resistance"),
        (["none", "--limit", "armature_resistance=nan"], "--limit: armature_resistance is nan"),
        (["none", "--limit", "backlash.gap=-1"], "--limit: backlash.gap is -1"),
        (["none", "--pattern", "{what}"], "is no folder"),
    ],
)
def test_what_cannot_be_begun_is_one_line(tmp_path, monkeypatch, capsys, arguments, said):
    pytest.importorskip("pyarrow", reason="needs pyarrow")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ending:
        main(["fleet", *arguments, "-o", "out"])
    assert ending.value.code == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_worker_needs_no_more_than_the_name_of_a_controller():
    judged = tuned_there("PI", Goal(), Effort(generations=0, members=4, seed=1, jobs=1))
    assert judged.name == "PI" and set(judged.responses) == set(judged.plants)
