"""What the predictor of the controller has to know of a plant: its dead time and lag, and the shaft that slides."""

from __future__ import annotations

from pierburg_ros.closed_loop.load import duty_for, load, transmission
from pierburg_ros.effects import EFFECTS
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model


def dead_time(model: Model) -> float:
    """Time [s] for which a command has no effect."""
    return sum(model.values[f"{each.id}.{each.dead_time}"] for each in EFFECTS if each.dead_time)


def lag(model: Model) -> float:
    """Time constant [s] of the lag of the measurement; of several, their sum."""
    return sum(model.values[f"{each.id}.{each.lag}"] for each in EFFECTS if each.lag)


def predictor(model: Model, rate: float) -> dict[str, float]:
    """Settings of the predictor for the plant `model`, sampled at `rate` [Hz], to four digits.

    The sliding shaft of the base parameters, as in `time_optimal`: at full duty it would reach supply / transmission
    if neither load nor friction held it back. The loop itself is one sample late. InputError where the model has no
    spring, or neither dead time nor lag.
    """
    value = model.values
    if dead_time(model) == 0.0 and lag(model) == 0.0:
        raise InputError("Found neither dead time nor lag in the model, so there is nothing to predict. Leave it out.")
    stops = model.actuator.upper_stop - model.actuator.lower_stop
    span = value["hall_voltage_open"] - value["hall_voltage_closed"]
    found = {
        "predictor_delay": dead_time(model) + 1.0 / rate,
        "predictor_lag": lag(model),
        "predictor_speed": value["supply_voltage"] / transmission(model) * span / stops,
        "predictor_friction": duty_for(model, value["coulomb_friction"]),
    }
    return load(model) | {name: float(f"{number:.4g}") for name, number in found.items()}
