"""`pierburg inspect` and `pierburg recover` as a person calls them."""

import json

import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.recording import read_recording


def call(*arguments):
    """Exit status of a command."""
    with pytest.raises(SystemExit) as end:
        main([str(each) for each in arguments])
    return end.value.code


def test_topics_rates_losses_and_what_they_are_read_as(capsys, bag_with_a_gap):
    assert call("inspect", bag_with_a_gap, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    duty, hall = found["topics"]
    assert (duty["name"], duty["count"], duty["lost"], duty["read_as"]) == ("/duty", 90, 10, "duty")
    assert (hall["count"], hall["lost"], hall["rate"]) == (100, 0, pytest.approx(100.0))
    assert (hall["minimum"], hall["maximum"]) == (0.0, 99.0)
    assert found["read_as"]["unknown_input"] == [pytest.approx([0.291, 0.401])]
    assert found["problem"] is None


def test_losses_come_first_in_what_a_person_reads(capsys, bag_with_a_gap):
    assert call("inspect", bag_with_a_gap) == 0
    text = capsys.readouterr().out
    assert text.startswith("Messages are missing: duty 10 of 100 messages.")
    assert "Duty unknown: 0.291 to 0.401 s" in text


def test_a_file_that_makes_no_recording_is_shown_with_the_reason(capsys, write_bag, run):
    path = write_bag([m for m in run(20) if m.topic == "/duty"])
    assert call("inspect", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["read_as"] is None
    assert "has no measured signal topic" in found["problem"]


def test_columns_of_a_table(capsys, tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time,duty,position,note\n" + "".join(f"{k / 10},0.5,{k},a\n" for k in range(20)))
    assert call("inspect", path, "--json") == 0
    topics = {each["name"]: each for each in json.loads(capsys.readouterr().out)["topics"]}
    assert topics["position"]["maximum"] == 19.0
    assert topics["duty"]["rate"] == pytest.approx(10.0)
    assert topics["note"]["read_as"] is None


def test_the_replay_of_such_a_recording_says_so_first(capsys, bag_with_a_gap, tmp_path):
    assert call("replay", bag_with_a_gap, "--actuator", "pierburg", "--output", tmp_path / "out") == 0
    assert capsys.readouterr().out.startswith("run.mcap: Messages are missing: duty 10 of 100 messages.")


def test_recover_writes_beside_the_original_and_leaves_a_whole_file_alone(capsys, bag_with_a_gap):
    assert call("recover", bag_with_a_gap) == 0
    assert "is whole" in capsys.readouterr().out
    cut = bag_with_a_gap.with_name("part.cut.mcap")
    cut.write_bytes(bag_with_a_gap.read_bytes()[:-50])
    assert call("recover", cut) == 0
    assert "part.recovered.mcap: 190 messages" in capsys.readouterr().out
    assert read_recording(cut.with_name("part.recovered.mcap")).time.size == 100
    assert call("recover", cut) == 2
    assert "exists, expected a new name" in capsys.readouterr().err
