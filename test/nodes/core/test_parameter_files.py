"""Parameter files that say nothing to a node, told from those that do."""

import pytest

from pierburg_ros.nodes.core.parameter_files import matches, unread_files


@pytest.mark.parametrize(
    ("key", "node"),
    [
        ("/plant", "/plant"),
        ("/**", "/plant"),
        ("/**", "/left/bench/plant"),
        ("/**/plant", "/plant"),
        ("/**/plant", "/left/plant"),
        ("/*/plant", "/left/plant"),
        ("/left/*", "/left/plant"),
    ],
)
def test_a_key_holds_for_a_node(key, node):
    assert matches(key, node)


@pytest.mark.parametrize(
    ("key", "node"), [("/plant", "/left/plant"), ("/*", "/left/plant"), ("/**/plant", "/left/motor"), ("/pl", "/plant")]
)
def test_a_key_does_not_hold_for_a_node(key, node):
    assert not matches(key, node)


def test_a_file_of_which_nothing_holds_is_named_with_what_it_names(tmp_path):
    mine, all_of_them = tmp_path / "mine.yaml", tmp_path / "all.yaml"
    mine.write_text("left:\n  plant: {ros__parameters: {rate: 200.0}}\nmotor: {ros__parameters: {rate: 1.0}}\n")
    all_of_them.write_text("/**: {ros__parameters: {rate: 200.0}}\n")
    arguments = ["--ros-args", "--params-file", str(mine), "--params-file", str(all_of_them)]
    assert unread_files("/left/plant", arguments) == []
    (complaint,) = unread_files("/plant", arguments)
    assert "mine.yaml says nothing to /plant (it names /left/plant, /motor)" in complaint
