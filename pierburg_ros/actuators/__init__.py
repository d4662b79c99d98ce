"""What is being simulated: actuators as data."""

from pierburg_ros.actuators.actuator import Actuator, NominalParameter
from pierburg_ros.actuators.description import SHIPPED, actuator_of, read_actuator
from pierburg_ros.actuators.scales import Scales

__all__ = ["SHIPPED", "Actuator", "NominalParameter", "Scales", "actuator_of", "read_actuator"]
