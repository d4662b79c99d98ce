"""The actuator as a node: duty in, Hall voltage out, at a steady rate."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import Any

from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.controller_parameters import WINDING
from pierburg_ros.nodes.core.joint import joint_name
from pierburg_ros.nodes.core.pacing import Pacer
from pierburg_ros.nodes.core.physics import Physics, chosen_model
from pierburg_ros.nodes.core.plant_parameters import PLANT
from pierburg_ros.nodes.core.plant_time import Lockstep, tick_as_time_source, tick_by_clock
from pierburg_ros.nodes.core.protection.limits import limits_of
from pierburg_ros.nodes.core.protection.winding import Winding
from pierburg_ros.nodes.core.sampled_plant import Sample, SampledPlant
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.qos import PUBLISHED
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.nodes.graph.signals import Signal
from pierburg_ros.nodes.recording.held_back import HeldBack
from pierburg_ros.nodes.reports.heat import HeatReport
from pierburg_ros.nodes.reports.plant import PlantReports

SWITCH_INTERVAL = 0.0005
"""Longest turn of one thread [s] while another waits; Python's own 5 ms are more than a period."""


class PlantNode(LiveNode):
    """Publishes the sampled shaft of a simulated actuator and obeys `duty`."""

    def __init__(self) -> None:
        super().__init__("plant")
        self.lock = Lock()
        self.pacer = Pacer(0.0)
        self._thread = ThreadPoolExecutor(1, "ticks")
        self.plant: SampledPlant | None = None
        self.declare((*PLANT, *WINDING), more=True)
        self.plant = self._sampled_plant()
        self._reports = PlantReports(self)
        self._heat = HeatReport(self.diagnostics, self.plant.winding)
        self.declare(self.plant.physics.declarations())
        self.lockstep = Lockstep(self.stopping) if self.values["lockstep"] else None
        self._clock_publisher = self.create_publisher(Clock, "/clock", PUBLISHED) if self.is_time_source else None
        self.held_back = HeldBack(self, self.diagnostics, self.stopping) if self.is_time_source else None
        self._hall_publisher = self.create_publisher(Float64, "hall_voltage", PUBLISHED)
        self._duty_publisher = self.create_publisher(Float64, "applied_duty", PUBLISHED)
        self._joint = joint_name(self.values["joint"], self.get_namespace())
        self._joint_publisher = self.create_publisher(JointState, "joint_states", PUBLISHED)
        self._duty = Signal(self, Float64, "duty", self._on_duty)
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.open_parameters()

    @property
    def is_time_source(self) -> bool:
        """Whether this node makes the time of the graph."""
        return bool(self.values["simulated_time"] or self.values["lockstep"])

    @property
    def is_simulated(self) -> bool:
        """Whether time is simulated, by this node or by another."""
        return self.is_time_source or super().is_simulated

    def accept(self, changes: Mapping[str, Any]) -> None:
        """Put parameters in force between two ticks."""
        if self.plant is None:
            return
        with self.lock:
            physics = self.plant.physics
            physics.change({name: value for name, value in changes.items() if physics.has(name)})
            physics.noise = changes.get("hall_voltage_noise", physics.noise)
            sensor = self.plant.sensor
            sensor.time_constant = changes.get("velocity_time_constant", sensor.time_constant)
            self._protect(self.plant.winding, {**self.values, **changes})

    def counters(self) -> Mapping[str, object]:
        """Ticks so far and those left out."""
        ticks = self.plant.ticks if self.plant else 0
        return {"ticks": ticks, "skipped_ticks": self.pacer.skipped}

    def now(self) -> int:
        """What the node's clock says [ns]."""
        return int(self.get_clock().now().nanoseconds)

    def follows(self, time: int) -> bool:
        """Whether `time` [ns] lies after the last tick, 0 being none; a clock set back counts from where it is."""
        if self.plant.last is not None and time < self.plant.last:
            self.plant.last = time
        return time > (self.plant.last or 0)

    def tick(self, time: int) -> Sample:
        """One tick at `time` [ns]."""
        timeout = self.values["command_timeout"]
        with self.lock:
            sample = self.plant.tick(time, timeout)
        self._reports.timeout(self.plant.duty.lost(time, timeout), timeout)
        self._heat.tell()
        return sample

    def publish(self, sample: Sample, with_clock: bool = False) -> None:
        """The messages of one tick, in the order of section 2 of docs/contract.md."""
        if with_clock:
            self._clock_publisher.publish(messages.clock(sample.time))
        self._hall_publisher.publish(messages.number(sample.hall_voltage))
        self._duty_publisher.publish(messages.number(sample.duty))
        self._joint_publisher.publish(messages.joint_state(self._joint, sample.time, sample.angle, sample.velocity))

    def begin(self) -> None:
        """Tick in a thread of its own while duties, parameters and services are served."""
        sys.setswitchinterval(SWITCH_INTERVAL)
        self._ticking = self._thread.submit(self._tick)
        self._ticking.add_done_callback(lambda _: self.stopping.set())

    def close(self) -> None:
        """End the thread, and raise what ended it if anything did."""
        self._thread.shutdown()
        self._ticking.result()

    def _tick(self) -> None:
        if self.lockstep is not None:
            self.lockstep.wait_for_partners(self._has_partners)
        if self.is_time_source:
            tick_as_time_source(self, self.lockstep)
        else:
            self.pacer.restart()
            tick_by_clock(self)

    def _sampled_plant(self) -> SampledPlant:
        values = self.values
        model = chosen_model(values["actuator"], values["model"])
        self.get_logger().info("preparing the simulator, which is compiled at its first start on a machine")
        physics = Physics(model, values["formulation"], values["hall_voltage_noise"], values["seed"])
        self.diagnostics.hardware_id = values["hardware_id"] or model.actuator.name
        self._actuator = model.actuator
        winding = Winding(limits_of(model.actuator), 0.0, 0.0)
        return SampledPlant(physics, ShaftSensor(model.actuator, values["velocity_time_constant"]), winding)

    def _protect(self, winding: Winding, values: Mapping[str, Any]) -> None:
        """Parameters of the stall protection in force; a device's rating does not follow its supply."""
        winding.rated_current = values["rated_current"] or limits_of(self._actuator).rated_current
        winding.time_constant = values["thermal_time_constant"]
        winding.limits = limits_of(self._actuator, self.plant.physics.values)

    def _has_partners(self) -> bool:
        return self._hall_publisher.get_subscription_count() > 0 and self._duty.publishers > 0

    def _on_duty(self, message: Float64) -> None:
        try:
            self._reports.duty(message.data, self.plant.duty.offer(message.data))
        except InputError as error:
            self._reports.refused(str(error))
        if self.lockstep is not None:
            self.lockstep.reply()

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        with self.lock:
            self.plant.reset()
        response.success, response.message = True, "at the closed stop, at rest and cold"
        return response


def main() -> None:
    """Run the plant."""
    run(PlantNode)
