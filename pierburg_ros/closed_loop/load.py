"""What a plant needs of duty to carry its load: the schedule over the working point, which the predictor knows too."""

from __future__ import annotations

from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model

NEEDED = ("spring_stiffness", "spring_preload", "coulomb_friction", "supply_voltage", "hall_voltage_closed")


def load(model: Model) -> dict[str, float]:
    """Settings of the schedule: the duty that balances spring and preload at either stop, to four digits.

    The base parameters; what effects add to the load is left to the integrator. InputError where there is no spring.
    """
    value = model.values
    if missing := [name for name in NEEDED if name not in value]:
        raise InputError(f"Found no {missing[0]} in {model.actuator.name}, which a schedule of the load needs.")
    stops = model.actuator.upper_stop - model.actuator.lower_stop
    preload = value["spring_preload"]
    found = {
        "load_closed": duty_for(model, preload),
        "load_open": duty_for(model, preload + value["spring_stiffness"] * stops),
    }
    return {name: float(f"{number:.4g}") for name, number in found.items()}


def duty_for(model: Model, torque: float) -> float:
    """Duty [1] that balances a torque [N.m] at the shaft at rest."""
    value = model.values
    return value["armature_resistance"] * torque / (transmission(model) * value["supply_voltage"])


def transmission(model: Model) -> float:
    """Torque at the shaft for each ampere [N.m/A]."""
    return model.values["gear_ratio"] * model.values["torque_constant"]
