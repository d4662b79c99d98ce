"""The controller: PI-fuzzy logic control of the shaft angle; it knows nothing of the plant."""

from pierburg_ros.control.parameter_file import parameter_file, read_parameter_file
from pierburg_ros.control.piflc import Controller, Internals
from pierburg_ros.control.schedule import Schedule, read_duty_file, read_setpoint_file
from pierburg_ros.control.setpoints import Setpoints
from pierburg_ros.control.settings import SETTINGS, Settings

__all__ = [
    "SETTINGS",
    "Controller",
    "Internals",
    "Schedule",
    "Setpoints",
    "Settings",
    "parameter_file",
    "read_duty_file",
    "read_parameter_file",
    "read_setpoint_file",
]
