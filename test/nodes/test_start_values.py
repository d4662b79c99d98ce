"""What is given at the start holds, or the start ends: no node runs on defaults that nobody chose."""

import pytest

pytest.importorskip("rclpy")

pytestmark = pytest.mark.ros


@pytest.mark.parametrize(
    ("node", "given", "lines"),
    [
        (
            "controller",
            ("setpoint:=9.0", "proportional_gain:=2.0"),
            ["Setpoint 9 rad is beyond the stops; give an angle from 0 to 1.5708 rad."],
        ),
        (
            "controller",
            ("hall_timout:=0.1", "close_duty:=2.0"),
            [
                "close_duty is 2; expected 0 to 1.",
                "controller has no parameter 'hall_timout'; 'ros2 param list' shows those it has. Did you mean"
                " hall_timeout?",
            ],
        ),
        ("plant", ("rate:=fast",), ["rate is 'fast'; expected a number."]),
        ("plant", ("armature_resistance:=-1.0",), ["armature_resistance is -1; expected 0.1 to 50 ohm."]),
        ("recorder", ("flush_interval:=99.0",), ["flush_interval is 99; expected 0.02 to 10 s."]),
    ],
)
def test_a_bad_or_unknown_value_ends_the_start_with_a_line_for_each(graph, node, given, lines):
    status, output = graph.ended(graph.start(node, *given), by=None)
    assert status == 2
    assert output.splitlines()[-len(lines) :] == lines
    assert not list(graph.folder.glob("recordings/*"))


def test_a_file_that_says_nothing_to_a_node_ends_its_start(graph):
    file = graph.folder / "mine.yaml"
    file.write_text("plant:\n  ros__parameters:\n    rate: 200.0\n")
    process = graph.start("plant", arguments=("-r", "__ns:=/left", "--params-file", str(file)))
    status, output = graph.ended(process, by=None)
    assert status == 2
    assert output.splitlines()[-1].startswith(f"{file} says nothing to /left/plant (it names /plant)")


def test_a_file_that_is_not_there_ends_the_start_with_one_line(graph):
    process = graph.start("controller", arguments=("--params-file", "nowhere.yaml"))
    status, output = graph.ended(process, by=None)
    assert status == 2
    assert "nowhere.yaml" in output
    assert "Traceback" not in output
