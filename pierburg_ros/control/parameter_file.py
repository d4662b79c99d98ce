"""Controller settings in the form of a ROS 2 parameter file, which node and simulation both take."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pierburg_ros.control.settings import SETTINGS, Settings
from pierburg_ros.errors import InputError
from pierburg_ros.intake import read_yaml, reading

NODE = "controller"
ANY = "/**"
"""Key of a node of any name in any namespace."""
FORM = "a parameter file (YAML)"
NODE_PARAMETERS = {
    *("use_sim_time", "depth", "actuator", "hardware_id", "autostart", "exclusive", "joint", "command"),
    *("command_timeout", "setpoint", "setpoint_file", "hall_timeout", "publish_internals", "longest_step"),
    *("hall_margin", "top_speed", "angle_timeout", "frozen_retry", "on_fault", "hold_time", "close_duty"),
    *("rated_current", "thermal_time_constant"),
}
"""Parameters of the controller's node that are not settings of the control law."""


def parameter_file(settings: Settings, header: Iterable[str] = ()) -> str:
    """The text of a parameter file with every setting, its unit and its meaning, under `header` lines."""
    lines = [*(f"# {line}" for line in header), f"{ANY}:", "  ros__parameters:"]
    for setting in SETTINGS:
        value = getattr(settings, setting.name)
        lines.append(f"    {setting.name}: {ros_double(value)}  # {setting.unit}, {setting.meaning}")
    return "\n".join(lines) + "\n"


def ros_double(value: float) -> str:
    """A number as YAML that ROS reads as a double: always with a point."""
    text = repr(float(value))
    mantissa, exponent, power = text.partition("e")
    return (mantissa if "." in mantissa else f"{mantissa}.0") + exponent + power


def read_parameter_file(path: str | Path) -> Settings:
    """The settings in a parameter file; what it does not name keeps its default."""
    with reading(path, FORM):
        content = read_yaml(path, FORM).content
    given = {name: value for name, value in parameters_of(content, path).items() if name not in NODE_PARAMETERS}
    try:
        return Settings().with_values(given)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def parameters_of(content: Any, path: str | Path) -> dict[str, Any]:
    """The parameters that a file's content has for the node `controller`, in whatever namespace."""
    nodes = content.items() if isinstance(content, dict) else ()
    for node, section in nodes:
        if str(node).split("/")[-1] in (NODE, ANY.strip("/")) and isinstance(section, dict):
            parameters = section.get("ros__parameters")
            if isinstance(parameters, dict):
                return parameters
    raise InputError(f"{path} has no section {NODE}: ros__parameters; write the settings below these keys.")
