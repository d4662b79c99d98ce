"""YAML inputs: models, actuators, controller settings."""

import random
from pathlib import Path

from fuzzing.mutations import laughing, mutated_text

PACKAGE = Path(__file__).parents[2] / "pierburg_ros"
MODEL = """actuator: pierburg
parameters: {armature_resistance: 4.71, coulomb_friction: 0.2}
effects:
  static_friction: {breakaway_torque: 0.27, stribeck_velocity: 0.1}
  backlash: {gap: 0.02, motor_friction_share: 0.5}
residual_torque: {angle: [0.0, 1.0], velocity: [-1.0, 1.0], torque: [[0.1, 0.2], [0.3, 0.4]]}
"""
SETTINGS = """controller:
  ros__parameters:
    proportional_gain: 1.0
    integral_gain: 2.72
    hall_voltage_open: 4.52
    use_sim_time: true
"""


def text_of(chance: random.Random, text: str) -> bytes:
    """`text`, mutated most times, as bytes."""
    if chance.random() < 0.9:
        text = mutated_text(chance, text)
    if chance.random() < 0.03:
        text = laughing(chance, text)
    return text.encode("utf-8", "surrogateescape")


def model(chance: random.Random) -> bytes:
    """A model file."""
    return text_of(chance, MODEL)


def actuator(chance: random.Random) -> bytes:
    """An actuator description."""
    name = chance.choice(("pierburg", "xl330"))
    return text_of(chance, (PACKAGE / "actuators" / f"{name}.yaml").read_text(encoding="utf-8"))


def settings(chance: random.Random) -> bytes:
    """A parameter file of the controller."""
    return text_of(chance, SETTINGS)
