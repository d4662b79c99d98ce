"""What an actuator can do at most, derived from its nominal numbers: the scales of every protection."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from pierburg_ros.actuators import Actuator

SPEED_MARGIN = 1.5
"""Factor on the derived top speed. The supply of a vehicle reaches 14.5 V where 13.5 V is nominal (x 1.07), torque
constants scatter by 10 % and more (x 1.1), and a sensor curved by 5 % of its span is up to 1.16 times as steep as
its line: 1.37 together."""
FRICTION_MARGIN = 3.0
"""Multiple of the nominal friction beyond which a duty is sure to move the shaft. Breakaway torques of twice the
sliding friction are common in dry gears; the third part pays for a winding that is 25 % warm."""
RATED_SHARE = 1.0 / 3.0
"""Continuous current as a share of the stall current at the nominal supply. Assumption: no data sheet of the motor is
known. It lies above what the valve needs for moving at its strongest spring torque (0.87 A of 3.26 A)."""
LEAST_SUPPLY = 1e-6
"""A supply below this [V] counts as this: no duty moves the shaft then, and none is said to."""


@dataclass(frozen=True)
class Limits:
    """Scales of one actuator, at its shaft."""

    top_speed: float  # of the shaft, with margin [rad/s]
    resistance: float  # of the winding [ohm]
    torque_constant: float  # motor torque at the shaft per current, and induced voltage per shaft speed [N.m/A]
    supply_voltage: float  # [V]
    closes_below: float  # duties below this move a shaft that is not at its closed stop [1]
    opens_above: float  # duties above this move a shaft that is not at its open stop [1]
    described_current: float = 0.0  # that the winding bears for ever, by the actuator's description [A]; 0: not said

    @property
    def stall_current(self) -> float:
        """Current at full duty and standstill [A]."""
        return self.supply_voltage / self.resistance

    @property
    def rated_current(self) -> float:
        """Current that the winding bears for ever, as described or else assumed [A]."""
        return self.described_current or RATED_SHARE * self.stall_current


def limits_of(actuator: Actuator, values: Mapping[str, float] | None = None) -> Limits:
    """The limits that follow from an actuator's nominal parameters, or from other `values` of them.

    Top speed: the motor's no-load speed, and what the load adds where it drives: a frictionless shaft under full
    duty turns at supply / constant + load resistance / constant^2.
    """
    value = {**nominal(actuator), **(values or {})}
    constant = value["gear_ratio"] * value["torque_constant"]
    weakest, strongest = load_torques(actuator, value)
    resistance, supply = value["armature_resistance"], value["supply_voltage"]
    driven = max(abs(weakest), abs(strongest)) * resistance / constant**2
    friction = FRICTION_MARGIN * value["coulomb_friction"]
    per_torque = resistance / (constant * max(supply, LEAST_SUPPLY))
    return Limits(
        SPEED_MARGIN * (supply / constant + driven),
        resistance,
        constant,
        supply,
        closes_below=(weakest - friction) * per_torque,
        opens_above=(strongest + friction) * per_torque,
        described_current=actuator.winding.rated_current if actuator.winding else 0.0,
    )


def nominal(actuator: Actuator) -> dict[str, float]:
    """The nominal value of every parameter."""
    return {name: parameter.nominal for name, parameter in actuator.parameters.items()}


def load_torques(actuator: Actuator, value: Mapping[str, float]) -> tuple[float, float]:
    """Weakest and strongest torque [N.m] that closes, of spring or pendulum, between the stops."""
    if actuator.load == "none":
        return 0.0, 0.0
    if actuator.load == "pendulum":
        return -value["gravity_torque"], value["gravity_torque"]
    travel = actuator.upper_stop if math.isfinite(actuator.upper_stop) else math.pi / 2
    return value["spring_preload"], value["spring_preload"] + value["spring_stiffness"] * travel
