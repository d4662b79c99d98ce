"""A launch file evaluated without `launch`, which is on no package index: what it declares and what it starts."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from unittest import mock

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "launch" / "closed_loop.launch.py"


class Substitution:
    """A launch argument, or the package's share folder, looked up in the context."""

    def __init__(self, name: str) -> None:
        self.name = name

    def perform(self, context: dict[str, str]) -> str:
        """The text in its place."""
        return context[self.name]


def stubs() -> dict[str, ModuleType]:
    """Stand-ins for the modules that the launch file imports; their actions keep what they are given."""
    names = ("launch", "launch.actions", "launch.event_handlers", "launch.substitutions")
    of_ros = ("launch_ros", "launch_ros.actions", "launch_ros.substitutions")
    modules = {name: ModuleType(name) for name in (*names, *of_ros)}
    modules["launch"].LaunchDescription = list
    modules["launch.actions"].DeclareLaunchArgument = lambda name, **said: SimpleNamespace(name=name, said=said)
    modules["launch.actions"].OpaqueFunction = lambda function: SimpleNamespace(function=function)
    modules["launch.actions"].ExecuteProcess = dict
    modules["launch.actions"].RegisterEventHandler = lambda handler: handler
    modules["launch.event_handlers"].OnProcessExit = SimpleNamespace
    modules["launch.substitutions"].LaunchConfiguration = Substitution
    modules["launch_ros.substitutions"].FindPackageShare = Substitution
    modules["launch_ros.substitutions"].ExecutableInPackage = lambda name, package: f"{package}/{name}"
    modules["launch_ros.actions"].Node = dict
    return modules


def launched(file: Path = LAUNCH, **given: str) -> tuple[dict[str, dict[str, Any]], list[Any]]:
    """The declared arguments by name, and what each node or process is given for these launch arguments."""
    specification = importlib.util.spec_from_file_location(file.name.split(".")[0], file)
    module = importlib.util.module_from_spec(specification)
    with mock.patch.dict(sys.modules, stubs()):
        specification.loader.exec_module(module)
        *declared, opaque = module.generate_launch_description()
    arguments = {each.name: each.said for each in declared}
    context = {name: said["default_value"] for name, said in arguments.items() if "default_value" in said} | given
    return arguments, opaque.function({**context, "pierburg_ros": str(ROOT)})


def command_line(node: dict[str, Any], folder: Path) -> list[str]:
    """The ROS arguments with which `launch_ros` starts a node: its names, then a file for each set of parameters."""
    file, values = node["parameters"]
    own = folder / f"{node['namespace']}_{node['name']}.yaml"
    lines = [f"    {name}: {literal(value)}" for name, value in values.items()]
    own.write_text("/**:\n  ros__parameters:\n" + "\n".join(lines) + "\n")
    names = ["-r", f"__node:={node['name']}", "-r", f"__ns:=/{node['namespace']}"]
    return ["--ros-args", *node["ros_arguments"], *names, "--params-file", file, "--params-file", str(own)]


def literal(value: object) -> str:
    """A value as YAML."""
    return str(value).lower() if isinstance(value, bool) else repr(value)
