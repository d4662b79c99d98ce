"""Every parameter of actuators and nodes, from the declarations; those of effects have their own page."""

from __future__ import annotations

from collections.abc import Iterable

from pierburg_ros.actuators import SHIPPED, read_actuator
from pierburg_ros.nodes.core.controller_parameters import CONTROLLER, LAW, PROTECTION, WINDING
from pierburg_ros.nodes.core.monitor_parameters import MONITOR
from pierburg_ros.nodes.core.plant_parameters import PLANT
from pierburg_ros.nodes.core.recorder_parameters import RECORDER
from pierburg_ros.nodes.core.serial_driver_parameters import SERIAL_DRIVER
from pierburg_ros.parameter import Parameter
from reference.markdown import code, table

NODES = {
    "plant": (*PLANT, *WINDING),
    "controller": (*CONTROLLER, *PROTECTION, *WINDING, *LAW),
    "recorder": RECORDER,
    "monitor": MONITOR,
    "serial_driver": SERIAL_DRIVER,
}
MOST = 60
"""Characters of a default that a cell shows."""


def page() -> str:
    """A section for each shipped actuator and each node."""
    actuators = (f"## Actuator `{name}`\n\n{_actuator(name)}" for name in SHIPPED)
    nodes = (f"## Node `{name}`\n\n{_node(declared)}" for name, declared in NODES.items())
    return "\n".join([*actuators, *nodes])


def _actuator(name: str) -> str:
    actuator = read_actuator(name)
    rows = (
        (
            code(each.name),
            f"{each.nominal:g}",
            each.unit,
            f"{each.minimum:g} to {each.maximum:g}",
            each.meaning,
            each.origin,
        )
        for each in actuator.parameters.values()
    )
    return f"{actuator.title}.\n\n" + table(("parameter", "nominal", "unit", "range", "meaning", "origin"), rows)


def _node(declared: Iterable[Parameter]) -> str:
    rows = ((code(each.name), code(_default(each)), each.allowed, each.meaning) for each in declared)
    return table(("parameter", "default", "allowed", "meaning"), rows)


def _default(parameter: Parameter) -> str:
    value = parameter.default
    text = f"{value:g}" if isinstance(value, float) else ", ".join(value) if isinstance(value, list) else str(value)
    return text if len(text) <= MOST else f"{text[:MOST]}..."
