"""A controller's place among all that send duties on its graph: watched, decided, said."""

from __future__ import annotations

import time

from std_msgs.msg import Float64

from pierburg_ros.nodes.controller_outputs import Outputs
from pierburg_ros.nodes.core.precedence import Precedence
from pierburg_ros.nodes.core.rate import Rate
from pierburg_ros.nodes.graph.diagnostics import ERROR, WARN
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.publishers import listed, publishers_of
from pierburg_ros.nodes.graph.qos import SIGNALS

TASK = "duty"
ASKED = 0.5
"""Samples that came within this time [s] count as coming."""


class Place:
    """Looks at the graph for other publishers of `duty` and of `hall_voltage`."""

    def __init__(self, node: LiveNode, started: float) -> None:
        self._node = node
        self._precedence = Precedence(started)
        self._listening = None
        node.diagnostics.task(TASK, "the only one", lambda: {"other_publishers": len(self._precedence.rivals)})

    def ask_anew(self) -> None:
        """Begin to look for a place."""
        self._precedence.stand_down(time.monotonic())

    def leave(self) -> None:
        """Give up the place and say nothing more about it."""
        self.ask_anew()
        self._listen(False)
        for condition in ("passive", "second_controller"):
            self._node.diagnostics.end(condition)

    def may_send(self, outputs: Outputs | None, samples: Rate, exclusive: bool) -> bool:
        """Whether to send duties now."""
        now, own = time.monotonic(), outputs.own if outputs else ""
        others = {key: name for key, name in publishers_of(self._node, "duty").items() if key != own}
        age = samples.age(now)
        may = self._precedence.may_send(now, others.keys(), own, asked=age is not None and age < ASKED)
        may = may or not exclusive
        names = listed([others[key] for key in self._precedence.rivals])
        self._say(may, names)
        self._listen(bool(names) and not may)
        self._watch_plants()
        return may

    def _say(self, may: bool, names: str) -> None:
        report = self._node.diagnostics
        if names and not may:
            report.begin("passive", WARN, f"{names} publishes duty: this controller stays passive", TASK)
        else:
            report.end("passive")
        if names and may:
            report.begin("second_controller", ERROR, f"{names} publishes duty too: two steer one actuator", TASK)
        else:
            report.end("second_controller")

    def _watch_plants(self) -> None:
        if self._node.count_publishers("hall_voltage") > 1:
            names = listed(list(publishers_of(self._node, "hall_voltage").values()))
            text = f"more than one publishes hall_voltage: {names}"
            self._node.diagnostics.begin("second_plant", ERROR, text, TASK)
        else:
            self._node.diagnostics.end("second_plant")

    def _listen(self, wanted: bool) -> None:
        """Hear the rivals' duties while passive; a dead one on the graph sends none."""
        if wanted and self._listening is None:
            self._listening = self._node.create_subscription(Float64, "duty", self._on_duty, SIGNALS)
        elif not wanted and self._listening is not None:
            self._node.destroy_subscription(self._listening)
            self._listening = None

    def _on_duty(self, _: Float64) -> None:
        self._precedence.heard(time.monotonic())
