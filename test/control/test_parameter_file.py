"""Controller settings as a ROS parameter file."""

import pytest
import yaml

from pierburg_ros.control import SETTINGS, Settings, parameter_file, read_parameter_file
from pierburg_ros.errors import InputError


def test_what_was_written_is_read_again(tmp_path):
    settings = Settings(proportional_gain=3, derivative_support=1e9, integral_dead_zone=0.00123456)
    path = tmp_path / "controller.yaml"
    path.write_text(parameter_file(settings, ["tuned for speed"]))
    assert read_parameter_file(path) == settings
    assert path.read_text().startswith("# tuned for speed\n/**:\n  ros__parameters:\n")


def test_every_value_is_a_double_and_says_what_it_is():
    text = parameter_file(Settings(proportional_gain=3.0, derivative_support=1e9))
    values = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert all(type(value) is float for value in values.values())
    for setting in SETTINGS:
        assert f"# {setting.unit}, {setting.meaning}" in text


def read(folder, text):
    path = folder / "file.yaml"
    path.write_text(text)
    return read_parameter_file(path)


@pytest.mark.parametrize("node", ["controller", "/bench/controller", "/**", "/**/controller"])
def test_finds_the_controller_in_any_namespace(tmp_path, node):
    text = f"plant: {{ros__parameters: {{rate: 500.0}}}}\n{node}: {{ros__parameters: {{zero: 0.1}}}}\n"
    assert read(tmp_path, text) == Settings(zero=0.1)


def test_passes_over_what_belongs_to_the_node(tmp_path):
    text = "controller: {ros__parameters: {use_sim_time: true, setpoint: 0.3, zero: 0.1}}"
    assert read(tmp_path, text) == Settings(zero=0.1)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "has no section controller: ros__parameters"),
        ("controller: 3", "has no section controller: ros__parameters"),
        ("a: [", "line 1 is not YAML .*; expected a parameter file"),
        ("controller: {ros__parameters: {gain: 3.0}}", "no setting 'gain'"),
        ("controller: {ros__parameters: {zero: fast}}", "zero is 'fast'; expected a number"),
    ],
)
def test_says_what_is_wrong_with_a_file(tmp_path, text, reason):
    with pytest.raises(InputError, match=reason):
        read(tmp_path, text)


def test_says_that_a_file_is_missing(tmp_path):
    with pytest.raises(InputError, match="does not exist, expected a parameter file"):
        read_parameter_file(tmp_path / "none.yaml")
