"""A launch file evaluated without `launch`, which is on no package index: what it declares and what it starts."""

from __future__ import annotations

import importlib.util
import sys
from itertools import pairwise
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from unittest import mock

import yaml

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
    own = ("actions", "event_handlers", "substitutions", "launch_description_sources")
    names = ("launch", *(f"launch.{each}" for each in own))
    of_ros = ("launch_ros", "launch_ros.actions", "launch_ros.substitutions")
    modules = {name: ModuleType(name) for name in (*names, *of_ros)}
    modules["launch"].LaunchDescription = list
    modules["launch.actions"].DeclareLaunchArgument = lambda name, **said: SimpleNamespace(name=name, said=said)
    modules["launch.actions"].OpaqueFunction = lambda function: SimpleNamespace(function=function)
    modules["launch.actions"].ExecuteProcess = dict
    modules["launch.actions"].Shutdown = SimpleNamespace
    modules["launch.actions"].SetEnvironmentVariable = lambda name, value: SimpleNamespace(name=name, said={})
    modules["launch.actions"].IncludeLaunchDescription = lambda file, launch_arguments: (file, dict(launch_arguments))
    modules["launch.launch_description_sources"].PythonLaunchDescriptionSource = Path
    modules["launch.substitutions"].EnvironmentVariable = lambda name, default_value: default_value
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


def given_to(node: dict[str, Any]) -> tuple[list[str], dict[str, Any]]:
    """The parameter files that a node is given, and the values by name, as ROS reads them."""
    given = list(pairwise(node["ros_arguments"]))
    files = [value for option, value in given if option == "--params-file"]
    rules = [value.split(":=", 1) for option, value in given if option == "-p"]
    return files, {name: yaml.safe_load(text) for name, text in rules}


def command_line(node: dict[str, Any]) -> list[str]:
    """The ROS arguments with which `launch_ros` starts a node."""
    names = ["-r", f"__node:={node['name']}", "-r", f"__ns:=/{node['namespace']}"]
    return ["--ros-args", *node["ros_arguments"], *names]
