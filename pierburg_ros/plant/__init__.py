"""The simulator: an actuator's differential equations, solved exactly between events."""

from pierburg_ros.plant.model import Model
from pierburg_ros.plant.model_file import read_model
from pierburg_ros.plant.plant import Plant
from pierburg_ros.plant.simulate import Inputs, simulate, simulate_many

__all__ = ["Inputs", "Model", "Plant", "read_model", "simulate", "simulate_many"]
