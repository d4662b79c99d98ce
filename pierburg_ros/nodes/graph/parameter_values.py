"""Asks other nodes for the values of all their parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import yaml
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.task import Future


class ParameterValues:
    """Hands over each node's values once, as YAML in the form of a parameter file."""

    def __init__(self, node: Node, names: Iterable[str], take: Callable[[str], None]) -> None:
        self._take = take
        self._missing: set[str] = set()
        self._list = {name: node.create_client(ListParameters, f"{name}/list_parameters") for name in names}
        self._get = {name: node.create_client(GetParameters, f"{name}/get_parameters") for name in names}

    def want(self) -> None:
        """Hand over the values of all nodes anew."""
        self._missing = set(self._list)

    def ask(self) -> None:
        """Ask the nodes that have not been asked and are there."""
        for name in sorted(self._missing):
            if self._list[name].service_is_ready() and self._get[name].service_is_ready():
                self._missing.discard(name)
                future = self._list[name].call_async(ListParameters.Request())
                future.add_done_callback(lambda future, name=name: self._listed(name, future))

    def _listed(self, name: str, future: Future) -> None:
        names = list(future.result().result.names)
        answer = self._get[name].call_async(GetParameters.Request(names=names))
        answer.add_done_callback(lambda future: self._answered(name, names, future))

    def _answered(self, name: str, names: list[str], future: Future) -> None:
        values = {
            key: parameter_value_to_python(value) for key, value in zip(names, future.result().values, strict=True)
        }
        self._take(yaml.safe_dump({name: {"ros__parameters": values}}, sort_keys=True))
