"""Numbers that follow from a description, with the limits of real actuators."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from pierburg_ros.actuators import Actuator
from pierburg_ros.actuators.units import unit_of

GRAVITY = 9.81
"""Acceleration of free fall [m/s^2]. Given: at sea level, to three digits."""
WEAKEST, STRONGEST = 1.0, 100.0
"""Smallest and largest ratio of the stall torque of the motor to the torque of load and friction. Derived: with less it
does not move. Chosen: the valve has 3.8, the bench 1.9, a drive that lifts its load slowly several tens."""
RUN_UP, HEAVIEST = 1e-7, 30.0
"""Smallest and largest ratio of the time in which the unloaded motor runs up to that in which it crosses the travel.
Chosen: the valve has 2e-4, a turntable or a reaction wheel up to several."""
QUICKEST, CROSSING = 1e-3, 60.0
"""Shortest and longest time in which the unloaded motor crosses the travel [s]. Given: a voice coil takes milliseconds,
a gate valve a minute."""
FAINTEST, FIERCEST = 1e-3, 1e3
"""Smallest and largest current of the stalled motor [A]. Given: a watch's motor draws a milliampere, a traction motor a
kiloampere."""
NARROWEST, WIDEST = 0.01, 20.0
"""Smallest and largest travel between stops [rad]. Chosen: half a degree to three turns; a travel of 90 is one in
degrees."""
SHORTEST_ARM, LONGEST_ARM = 1e-3, 10.0
"""Shortest and longest pendulum [m] that inertia and weight imply: inertia over weight times lever arm is length over
gravity. Given: what stands on a bench."""
ROUGHEST = 1.0
"""Largest ratio of friction to the weight of a pendulum. Derived: with more friction it does not swing."""


@dataclass(frozen=True)
class Derived:
    """A number that follows from others, with the limits within which real actuators lie."""

    name: str
    value: float
    unit: str
    least: float
    most: float
    reason: str

    @property
    def plausible(self) -> bool:
        """Whether a real actuator may have this value."""
        return self.least <= self.value <= self.most


def derived(actuator: Actuator) -> list[Derived]:
    """Every derived number that this kind of actuator has."""
    value = {name: parameter.nominal for name, parameter in actuator.parameters.items()}
    found = [*_of_travel(actuator), *_of_load(actuator, value)]
    if actuator.drive == "voltage":
        found += _of_motor(actuator, value)
    return found


def _of_travel(actuator: Actuator) -> Iterator[Derived]:
    travel = actuator.upper_stop - actuator.lower_stop
    if math.isfinite(travel) and actuator.motion == "rotary":
        reason = "Stops are in rad: a quarter turn is 1.57."
        yield Derived("travel", travel, "rad", NARROWEST, WIDEST, reason)


def _of_load(actuator: Actuator, value: dict[str, float]) -> Iterator[Derived]:
    weight = abs(value.get("gravity_torque", 0.0))
    if weight > 0.0 and actuator.motion == "rotary":
        arm = GRAVITY * value["total_inertia"] / weight
        reason = "total_inertia over gravity_torque is the length of a pendulum over gravity."
        yield Derived("length of the pendulum", arm, "m", SHORTEST_ARM, LONGEST_ARM, reason)
        friction = value["coulomb_friction"] / weight
        reason = "With more friction than weight a pendulum stays wherever it is put."
        yield Derived("friction over weight", friction, "1", 0.0, ROUGHEST, reason)


def _of_motor(actuator: Actuator, value: dict[str, float]) -> Iterator[Derived]:
    scales, motion = actuator.scales, actuator.motion
    needed = _needed(actuator, value)
    inertial = value["total_inertia"] * (scales.angle / scales.time) / scales.torque
    yield Derived(
        "no-load speed",
        scales.angle / scales.time,
        unit_of("rad/s", motion),
        0.0,
        math.inf,
        "supply over gear and constant.",
    )
    yield Derived(
        "stall torque", scales.torque, unit_of("N.m", motion), 0.0, math.inf, "gear, constant and stall current."
    )
    yield Derived(
        "stall current", scales.current, "A", FAINTEST, FIERCEST, "It is supply_voltage over armature_resistance."
    )
    yield Derived(
        "time to cross the travel",
        scales.time,
        "s",
        QUICKEST,
        CROSSING,
        "It is the travel over the no-load speed, which is supply_voltage over gear_ratio and torque_constant.",
    )
    yield Derived(
        "stall torque over load and friction",
        scales.torque / needed if needed else 1.0,
        "1",
        WEAKEST,
        STRONGEST if _is_loaded(value) else math.inf,
        "A motor that is weaker does not move its load, and one that is far stronger was not built for it.",
    )
    yield Derived(
        "time to run up over time to cross",
        inertial / scales.time,
        "1",
        RUN_UP,
        HEAVIEST,
        "total_inertia times the no-load speed over the stall torque is the time in which the motor runs up.",
    )


def _needed(actuator: Actuator, value: dict[str, float]) -> float:
    """Largest torque of load and friction [N.m]: at the far stop, or for a pendulum held level."""
    travel = actuator.upper_stop - actuator.lower_stop
    reach = travel if math.isfinite(travel) else 0.0
    spring = abs(value.get("spring_preload", 0.0)) + value.get("spring_stiffness", 0.0) * reach
    return value["coulomb_friction"] + spring + abs(value.get("gravity_torque", 0.0))


def _is_loaded(value: dict[str, float]) -> bool:
    """Whether anything except friction holds against the motor."""
    return any(value.get(name, 0.0) for name in ("spring_preload", "spring_stiffness", "gravity_torque"))
