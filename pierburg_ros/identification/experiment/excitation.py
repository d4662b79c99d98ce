"""Excitation recipes: duty or setpoint sequences, each of which shows something else about an actuator."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError, near
from pierburg_ros.identification.paper.lumps import lumps
from pierburg_ros.plant import Model

Random = np.random.Generator
SPEED_REACHED = 0.6
"""Share of the no-load speed that a free shaft reaches at the end of its range. Chosen: recipes go to nearly twice that
duty."""


@dataclass(frozen=True)
class DutyRange:
    """Duties [1] at which a shaft coming from rest begins to move and reaches the end of its travel, or a high speed.

    `turns`: nothing brings it back, so that shares below -1 drive it backwards.
    """

    low: float
    high: float
    turns: bool = False

    @staticmethod
    def of(model: Model) -> DutyRange:
        """The range from the lumps of a spring-loaded model.

        For a pendulum it is up to 60 degrees of deflection, and without a load up to `SPEED_REACHED`.
        """
        if model.actuator.drive != "voltage":
            raise InputError(
                f"Actuator {model.actuator.name} has drive {model.actuator.drive}; the recipes are duties. Give an"
                " input of your own."
            )
        if model.actuator.load == "spring":
            lump = lumps(model)
            low = (lump["preload_angle"] + lump["friction_angle"]) / lump["gain"]
            return DutyRange(low, low + min(model.actuator.upper_stop, math.tau) / lump["gain"])
        value = model.values
        per_duty = value["gear_ratio"] * value["torque_constant"] * value["supply_voltage"]
        scale = value["armature_resistance"] / per_duty
        low = value["coulomb_friction"] * scale
        if model.actuator.load == "none":
            return DutyRange(low, low + SPEED_REACHED, turns=True)
        return DutyRange(low, low + value["gravity_torque"] * math.sin(math.radians(60.0)) * scale)

    def at(self, share: float | Signal) -> Signal:
        """Duty [1] at a `share` of the range; for negative shares it falls from `low`, to 0 at -1, and goes on."""
        share = np.asarray(share, dtype=float)
        inside = self.low + share * (self.high - self.low)
        below = self.low * (1.0 + share)
        if self.turns:
            below = np.where(share < -1.0, (1.0 + share) * (self.high - self.low) - self.low, below)
        return np.asarray(np.clip(np.where(share >= 0.0, inside, below), -1.0, 1.0))


def held(time: Signal, random: Random, shortest: float, longest: float, draw: Callable[[], float]) -> Signal:
    """Random levels, each held for `shortest` to `longest`, in the unit of `time`."""
    levels = np.empty(time.size)
    start = time[0]
    while start <= time[-1]:
        end = start + random.uniform(shortest, longest)
        levels[(time >= start) & (time < end)] = draw()
        start = end
    return levels


def staircase(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Up and down in equal stairs of at least 2.5 beats, from rest to a little beyond the travel."""
    duration = time[-1] - time[0]
    stairs = int(np.clip(duration / 5.0, 4, 60))
    place = np.floor((time - time[0]) / (duration + 1e-9) * (2 * stairs + 1))
    return np.asarray(span.at(1.08) * (1.0 - np.abs(place - stairs) / stairs))


def steps(time: Signal, span: DutyRange, random: Random) -> Signal:
    """The paper's steps of Fig. 4: from rest to 24, 20 and 22 % (scaled to the actuator), 6 beats each way."""
    shares = np.array([-1.0, 0.69, -1.0, 0.21, -1.0, 0.45])
    place = np.floor((time - time[0]) / 6.0).astype(int) % shares.size
    return span.at(shares[place])


def random_steps(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Random levels held 0.8 to 2.5 beats, some to the stops, some negative."""
    return held(time, random, 0.8, 2.5, lambda: float(span.at(random.uniform(-1.6, 1.4))))


def sharp_steps(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Random levels held 0.1 to 0.6 beats, so that the shaft seldom settles."""
    return held(time, random, 0.1, 0.6, lambda: float(span.at(random.uniform(-1.8, 2.0))))


def ramps(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Triangles of random height, each 3 to 8 beats long, then rest for up to 2."""
    duty = np.zeros(time.size)
    start = time[0]
    while start <= time[-1]:
        length, top = random.uniform(3.0, 8.0), float(span.at(random.uniform(0.2, 1.1)))
        duty += top * np.clip(1.0 - np.abs(2.0 * (time - start) / length - 1.0), 0.0, 1.0)
        start += length + random.uniform(0.0, 2.0)
    return duty


def standstills(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Steps through the travel with rests of 0.1 to 4 beats between them, up and down."""
    return held(time, random, 0.1, 4.0, lambda: float(span.at(random.uniform(-0.7, 1.0))))


def stops(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Full runs onto the open stop and back onto the closed one, at rising duty, 3 beats each way."""
    place = np.floor((time - time[0]) / 3.0).astype(int)
    shares = np.array([1.1, 1.5, 2.0, 3.0, 5.0])
    return np.where(place % 2 == 1, span.at(shares[(place // 2) % shares.size]), 0.0)


def negative(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Negative duty against the closed stop, then a step open, 2 beats each: flanks part, dead bands show."""
    place = np.floor((time - time[0]) / 2.0).astype(int)
    closing = -span.low * np.array([0.25, 0.5, 1.0, 1.5])[(place // 2) % 4]
    opening = span.at(np.array([0.3, 0.6, 0.9])[(place // 2) % 3])
    return np.clip(np.where(place % 2 == 0, closing, opening), -1.0, 1.0)


def rich(time: Signal, span: DutyRange, random: Random) -> Signal:
    """Staircase, random steps, sharp steps and runs to the stops: what identification needs."""
    parts = np.array_split(time, [time.size * 2 // 5, time.size * 7 // 10, time.size * 17 // 20])
    recipes = (staircase, random_steps, sharp_steps, stops)
    return np.concatenate([recipe(part, span, random) for recipe, part in zip(recipes, parts, strict=True)])


def setpoints(time: Signal, random: Random) -> Signal:
    """Random setpoints over the travel, held 0.8 to 3 s [rad]."""
    return held(time, random, 0.8, 3.0, lambda: float(random.uniform(0.0, math.pi / 2)))


def square(time: Signal, random: Random) -> Signal:
    """A square wave between 20 and 60 degrees, 2 s each way, as in the paper's Fig. 12 [rad]."""
    place = np.floor((time - time[0]) / 2.0) % 2
    return np.radians(np.where(place == 0, 20.0, 60.0))


def sweep(time: Signal, random: Random) -> Signal:
    """A sine about the middle of the travel, its frequency rising from 0.1 to 2 Hz [rad]."""
    since = time - time[0]
    phase = 0.1 * since + 0.5 * 1.9 / max(since[-1], 1e-9) * since**2
    return np.asarray(0.5 * (math.pi / 2) + 0.35 * (math.pi / 2) * np.sin(2.0 * np.pi * phase))


DUTY_RECIPES = {
    function.__name__: function
    for function in (staircase, steps, random_steps, sharp_steps, ramps, standstills, stops, negative, rich)
}
SETPOINT_RECIPES = {function.__name__: function for function in (setpoints, square, sweep)}
DURATION = {"staircase": 150.0, "steps": 36.0, "rich": 120.0, "stops": 30.0, "negative": 24.0}
"""Duration [beats] of a recipe where none is given; 60 for the others. Derived: the time that the recipe takes once, 36
for three steps of 6 each way; the staircase has 2.5 a stair."""
BEAT = 10.473
"""Time unit of the duty recipes, in the actuator's own time. Given: a second for the valve, in which the paper
counts."""


def usual_duration(name: str, model: Model) -> float:
    """Duration [s] of recipe `name` where none is given; setpoint recipes are for the valve."""
    beat = BEAT * model.scales.time if name in DUTY_RECIPES else 1.0
    return float(f"{DURATION.get(name, 60.0) * beat:.3g}")


def purpose(name: str) -> str:
    """The sentence that says what recipe `name` does."""
    recipe = DUTY_RECIPES.get(name) or SETPOINT_RECIPES.get(name)
    if recipe is None:
        known = [*DUTY_RECIPES, *SETPOINT_RECIPES]
        raise InputError(f"There is no recipe {name}; expected one of {', '.join(known)}.{near(name, known)}")
    return " ".join((recipe.__doc__ or "").split())


def duty_sequence(name: str, model: Model, time: Signal, seed: int = 0) -> Signal:
    """Duty of recipe `name` at `time` [s], scaled to travel and time of `model`, shape (samples,)."""
    duty = DUTY_RECIPES[name](time / (BEAT * model.scales.time), DutyRange.of(model), np.random.default_rng(seed))
    return np.asarray(np.clip(np.round(duty, 5), -1.0, 1.0))


def setpoint_sequence(name: str, time: Signal, seed: int = 0) -> Signal:
    """Setpoints of recipe `name` at `time` [s], in rad, after half a second of rest, shape (samples,)."""
    sequence = SETPOINT_RECIPES[name](time, np.random.default_rng(seed))
    return np.where(time < time[0] + 0.5, 0.0, sequence)
