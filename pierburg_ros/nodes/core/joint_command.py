"""What a message of joint commands asks of one joint. Knows no ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pierburg_ros.errors import InputError

ARRAYS = {"position": "position", "duty": "effort"}
"""Where sensor_msgs/JointState has each kind of command."""


class JointCommand:
    """Finds the command for `joint` in messages that may be about others too.

    Messages about other joints alone are no fault once one was about this joint: several senders may share a topic.
    """

    def __init__(self, joint: str) -> None:
        self.joint = joint
        self._is_known = False

    def of(self, names: Sequence[str], values: Sequence[float]) -> float | None:
        """The number for the joint among `values`, one for each of `names`; None where nothing is commanded.

        ros2_control writes NaN, or no numbers, where nobody commands. InputError where the message cannot be for this
        joint: it has never been named, or not every name has its number.
        """
        if self.joint not in names:
            if self._is_known:
                return None
            raise InputError(
                f"joint_commands names {', '.join(names) or 'no joint'}, expected {self.joint}."
                " Give the joint that name in the ros2_control tag."
            )
        self._is_known = True
        if not len(values):
            return None
        if len(values) != len(names):
            raise InputError(
                f"joint_commands has {len(values)} numbers for {len(names)} joints, expected one for each."
                " Give all joints of the ros2_control tag the same command interfaces."
            )
        value = float(values[names.index(self.joint)])
        return None if math.isnan(value) else value
