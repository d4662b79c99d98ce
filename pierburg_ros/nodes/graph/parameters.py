"""Live parameters: declared from the core, checked in one place, set by service, topic or parameter file."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Mapping
from threading import Event
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rcl_interfaces.msg import Parameter as ParameterMessage
from rclpy.clock import JumpThreshold, TimeJump
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from pierburg_ros.errors import InputError, near
from pierburg_ros.nodes.core.depth import DEPTH, KEPT_MESSAGES
from pierburg_ros.nodes.core.parameter_files import unread_files
from pierburg_ros.nodes.graph.diagnostics import Diagnostics
from pierburg_ros.nodes.graph.qos import COMMANDS, PUBLISHED, overridable
from pierburg_ros.parameter import Parameter as Declaration
from pierburg_ros.parameter import Value

_OF_ROS = ("use_sim_time", "start_type_description_service", "qos_overrides")


class LiveNode(Node):
    """A node whose parameters are declared with unit and range, and which refuses with a reason.

    `values` holds what is in force. A subclass declares in its constructor, then calls `open_parameters`.
    """

    later: tuple[str, ...] = ()
    """Topics which a subclass has only at times, and for which `qos_overrides` may be given all the same."""

    def __init__(self, name: str) -> None:
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        self.stopping = Event()
        self.values: dict[str, Any] = {}
        self._declared: dict[str, Declaration] = {}
        self.diagnostics = Diagnostics(self, self.counters)
        self._given = self._overrides()
        backward = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        self._jumps = self.get_clock().create_jump_callback(backward, post_callback=self._on_jump_back)
        self._complaints = unread_files(self.get_fully_qualified_name(), sys.argv)

    @property
    def is_simulated(self) -> bool:
        """Whether time is simulated: then the plant waits for the recorder, and nothing may be overwritten before."""
        return bool(self.get_parameter("use_sim_time").value)

    @property
    def kept(self) -> int:
        """Messages that publishers of signals keep."""
        return KEPT_MESSAGES if self.is_simulated else int(self.values.get(DEPTH.name, KEPT_MESSAGES))

    def create_publisher(self, kind: type, topic: str, profile: Any, **options: Any) -> Publisher:
        """A publisher whose quality of service `qos_overrides` may change, if it is one of the project's topics."""
        options = overridable(profile, options)
        if profile is PUBLISHED:
            profile = QoSProfile(depth=self.kept, reliability=PUBLISHED.reliability)
        return super().create_publisher(kind, topic, profile, **options)

    def create_subscription(
        self, kind: type, topic: str, callback: Callable[..., None], profile: Any, **options: Any
    ) -> Subscription:
        """A subscription whose quality of service `qos_overrides` may change, as for publishers."""
        return super().create_subscription(kind, topic, callback, profile, **overridable(profile, options))

    def accept(self, changes: Mapping[str, Any]) -> None:
        """Put `changes`, each checked on its own, in force together; InputError refuses them all."""

    def begin(self) -> None:
        """Called once when the node is about to be served."""

    def close(self) -> None:
        """Called once when the node is no longer served, while it is still on the graph."""

    def counters(self) -> Mapping[str, object]:
        """Numbers for `/diagnostics`."""
        return {}

    def declare(self, declarations: Iterable[Declaration], more: bool = False) -> None:
        """Declare parameters with the values given at the start; `more`: other declarations follow.

        After the last ones InputError has a line for each value that is not acceptable and each name that is unknown.
        """
        declared = {each.name: each for each in declarations}
        self._declared.update(declared)
        values = {name: self._start_value(each) for name, each in declared.items()}
        self._complaints += [] if more else [self._unknown(name) for name in self._given]
        if not self._complaints:
            self.accept(values)
        if self._complaints and not more:
            raise InputError(*self._complaints)
        for name, value in values.items():
            self.declare_parameter(name, value, descriptor(declared[name]), ignore_override=True)
        self.values.update(values)

    def open_parameters(self) -> None:
        """From here on parameters can be set."""
        self.add_on_set_parameters_callback(self._on_set)
        self.create_subscription(ParameterMessage, "~/set_parameter", self._on_message, COMMANDS)
        for reason in self._unused_overrides():
            self.diagnostics.refuse(reason)

    def _start_value(self, declaration: Declaration) -> Value | None:
        """What was given at the start, or else the default; a complaint where it is not acceptable."""
        if declaration.name in self._given:
            try:
                return declaration.accepted(self._given.pop(declaration.name))
            except InputError as error:
                self._complaints.append(str(error))
        return declaration.default

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set all of them or none: the one way in for services, the topic and code."""
        try:
            checked = [self._checked(parameter) for parameter in parameter_list]
        except InputError as error:
            return self._refused(str(error))
        result = super().set_parameters_atomically(checked)
        return result if result.successful else self._refused(result.reason)

    def _on_jump_back(self, jump: TimeJump) -> None:
        self.diagnostics.refuse(f"the clock went back by {-jump.delta.nanoseconds * 1e-9:.3g} s")

    def _on_message(self, message: ParameterMessage) -> None:
        self.set_parameters_atomically([Parameter.from_parameter_msg(message)])

    def _on_set(self, parameters: list[Parameter]) -> SetParametersResult:
        changes = {p.name: p.value for p in parameters if p.name in self._declared}
        try:
            self.accept(changes)
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        self.values.update(changes)
        return SetParametersResult(successful=True)

    def _checked(self, parameter: Parameter) -> Parameter:
        if parameter.name in self._declared:
            value = self._declared[parameter.name].accepted(parameter.value)
            return Parameter(parameter.name, value=value)
        if not self.has_parameter(parameter.name):
            raise InputError(self._unknown(parameter.name))
        return parameter

    def _refused(self, reason: str) -> SetParametersResult:
        self.diagnostics.refuse(reason)
        return SetParametersResult(successful=False, reason=reason)

    def _unknown(self, name: str) -> str:
        meant = near(name, self._declared)
        return f"{self.get_name()} has no parameter {name!r}; 'ros2 param list' shows those it has.{meant}"

    def _unused_overrides(self) -> list[str]:
        """Complaints about qualities of service that were given for topics which this node does not have."""
        topics = {each.topic_name for each in (*self.publishers, *self.subscriptions)}
        topics |= {self.resolve_topic_name(topic) for topic in self.later}
        given = {name.split(".")[0] for name in self.get_parameters_by_prefix("qos_overrides")}
        return [
            f"{self.get_name()} has no topic {topic} for qos_overrides; write its full name, as in"
            f" {self.resolve_topic_name('name')}."
            for topic in sorted(given - topics)
        ]

    def _overrides(self) -> dict[str, Value]:
        """Values given at the start, taken out so that they can be checked first."""
        given = {name: p.value for name, p in self.get_parameters_by_prefix("").items()}
        given = {name: value for name, value in given.items() if name.split(".")[0] not in _OF_ROS}
        for name in given:
            self.undeclare_parameter(name)
        return given


def descriptor(declaration: Declaration) -> ParameterDescriptor:
    """Description, unit and range as tools show them."""
    message = ParameterDescriptor(
        name=declaration.name,
        description=declaration.description,
        additional_constraints=" or ".join(declaration.choices),
        read_only=declaration.fixed,
    )
    bounded = math.isfinite(declaration.minimum) and math.isfinite(declaration.maximum)
    if bounded and isinstance(declaration.default, float):
        message.floating_point_range = [
            FloatingPointRange(from_value=declaration.minimum, to_value=declaration.maximum)
        ]
    elif bounded and isinstance(declaration.default, int):
        message.integer_range = [IntegerRange(from_value=int(declaration.minimum), to_value=int(declaration.maximum))]
    return message
