"""The architecture's rule of who may import whom, read from the sources."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "pierburg_ros"
BASE = {"errors", "kernel", "processes"}
ALLOWED = {
    "errors": set(),
    "kernel": set(),
    "processes": {"errors"},
    "effects": {"errors", "kernel"},
    "actuators": {"errors", "kernel", "effects"},
    "plant": {"errors", "kernel", "effects", "actuators"},
    "control": {"errors", "kernel"},
    "recording": {"errors", "kernel"},
    "serial_line": {"errors"},
}
ALLOWED["monitoring"] = ALLOWED["plant"] | {"plant"}
ALLOWED["closed_loop"] = ALLOWED["plant"] | {"plant", "control", "recording"}
ALLOWED["estimation"] = ALLOWED["plant"] | {"plant", "recording"}
ALLOWED["comparison"] = ALLOWED["estimation"] | {"estimation"}
ALLOWED["identification"] = ALLOWED["comparison"] | {"comparison"}
ALLOWED["diagnosis"] = ALLOWED["estimation"] | {"estimation"}
ALLOWED["proof"] = ALLOWED["diagnosis"] | {"diagnosis", "comparison", "control", "closed_loop", "processes"}
ALLOWED["nodes"] = ALLOWED["proof"] | {"proof", "identification", "monitoring", "serial_line"}
ALLOWED["cli"] = ALLOWED["nodes"]
FORMULATION = {"errors", "kernel"}
ROS = {
    "builtin_interfaces",
    "diagnostic_msgs",
    "launch",
    "launch_ros",
    "rcl_interfaces",
    "rclpy",
    "rosgraph_msgs",
    "sensor_msgs",
    "std_msgs",
    "std_srvs",
}
SOURCES = sorted(PACKAGE.rglob("*.py"))


def imported(source):
    """Full names of the modules that a source file imports anywhere in it."""
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{source} imports relatively"
            yield node.module
            if node.module == "pierburg_ros":
                yield from (f"pierburg_ros.{alias.name}" for alias in node.names)


def unit(source):
    """The part of the package that a source file belongs to."""
    return source.relative_to(PACKAGE).parts[0].removesuffix(".py")


def units_imported(source):
    """Other parts of the package that a source file imports."""
    names = (name.split(".") for name in imported(source))
    return {name[1] for name in names if name[0] == "pierburg_ros" and len(name) > 1} - {unit(source)}


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_point_down_the_architecture(source):
    if unit(source) == "__init__":
        assert not units_imported(source)
        return
    allowed = FORMULATION if "formulation" in source.parts else ALLOWED[unit(source)]
    assert units_imported(source) <= allowed


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_ros_is_imported_in_nodes_alone(source):
    roots = {name.split(".")[0] for name in imported(source)}
    assert unit(source) == "nodes" or not roots & ROS


def test_every_part_of_the_package_has_its_place_in_the_rule():
    parts = {unit(source) for source in SOURCES} - {"__init__"}
    assert parts <= set(ALLOWED)
