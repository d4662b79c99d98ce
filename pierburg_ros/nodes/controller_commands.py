"""The way in from ros2_control: commands of the joint, as its hardware components for topics send them."""

from __future__ import annotations

from collections.abc import Callable

from sensor_msgs.msg import JointState

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.joint import joint_name
from pierburg_ros.nodes.core.joint_command import ARRAYS, JointCommand
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.signals import Signal


class JointCommands:
    """Hands each command of the node's joint on `joint_commands` to `take`, which may refuse it by InputError.

    `command` says which: position [rad] or duty [1].
    """

    def __init__(self, node: LiveNode, command: str, take: Callable[[float], object]) -> None:
        self._node, self._take, self._array = node, take, ARRAYS[command]
        self._command = JointCommand(joint_name(node.values["joint"], node.get_namespace()))
        self._signal = Signal(node, JointState, "joint_commands", self._on_command)

    def _on_command(self, message: JointState) -> None:
        try:
            value = self._command.of(message.name, getattr(message, self._array))
            if value is not None:
                self._take(value)
        except InputError as error:
            self._node.diagnostics.refuse(str(error))
