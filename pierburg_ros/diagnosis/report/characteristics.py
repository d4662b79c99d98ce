"""The laws inside a model as curves: friction, load, sensor and play, with points from the recordings around them.

The points are partial residuals: the final law plus what the recording lacks there. They lie on the final curve where
it is right (Larsen, McCleary, The use of partial residual plots in regression analysis (1972)).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from pierburg_ros.actuators.units import unit_of
from pierburg_ros.actuators.wording import place, travel_factor, travel_title
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.found import Found
from pierburg_ros.diagnosis.motion import motion_of
from pierburg_ros.diagnosis.remains import Lacking
from pierburg_ros.diagnosis.result import Characteristic, Points
from pierburg_ros.effects import EFFECTS
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit, decoded
from pierburg_ros.plant.torques import friction, load

CURVE_POINTS = 121
"""Number of points of a curve. Work: one is drawn every five pixels."""
POINTS_OF_CURVE = 24
"""Points of the recordings beside a curve. Chosen: each is the mean of a twenty-fourth of the samples."""
CORRELATED = 6.0
"""Neighbouring samples of the balance that count as one. Derived: so many are kept in a length of its filter."""


def characteristics(found: Found) -> tuple[Characteristic, ...]:
    """The laws of the actuator and its sensor; none for a sensor of speed, which shows no angle."""
    if found.data.actuator.quantity == "speed":
        return ()
    choice = found.choice
    models = {"nominal": choice.described.model, "recalibrated": choice.estimated.model, "final": found.model}
    at, run = found.lacking_of_written, found.data.runs[0]
    motion = motion_of(run, found.data.actuator, found.data.noise)
    residual = found.data.by_run(found.errors["final"])[0] * found.data.per_unit
    laws = [_friction(models, at), _load(models, at, motion.angle), _sensor(models, motion.angle, residual)]
    return (*laws, *_plays(found.model))


def _friction(models: Mapping[str, Model], missing: Lacking) -> Characteristic:
    """Friction over velocity at the median of the angles at which the shaft moved."""
    motion = models["final"].actuator.motion
    fastest = float(np.quantile(np.abs(missing.velocity), 0.98)) if missing.velocity.size else 1.0
    middle = float(np.median(missing.angle)) if missing.angle.size else 0.0
    # more nodes near standstill, where the law bends
    side = fastest * np.linspace(0.0, 1.0, CURVE_POINTS // 2) ** 2
    velocity = np.concatenate([-side[::-1], [math.nan], side])
    curves = {name: (velocity, friction_torque(model, velocity, middle)) for name, model in models.items()}
    inside = np.abs(missing.velocity) <= fastest
    known = ~np.isnan(velocity)
    law = np.interp(missing.velocity[inside], velocity[known], curves["final"][1][known])
    points = binned(missing.velocity[inside], law + np.sign(missing.velocity[inside]) * missing.own[inside])
    return Characteristic(
        "friction",
        f"friction at {place(middle, middle, motion)}",
        f"velocity [{unit_of('rad/s', motion)}]",
        f"friction [{unit_of('N.m', motion)}]",
        curves,
        points,
    )


def friction_torque(model: Model, velocity: Signal, angle: float) -> Signal:
    """Friction [N.m], positive when it hinders opening, at steady `velocity` [rad/s], shape (velocities,).

    The motor torque is the one that keeps that velocity. At velocity 0 the friction is the torque that breaks the shaft
    loose, on the side of the nearest other velocity.
    """
    record = model.record()[0]
    result = np.full(velocity.size, math.nan)
    middle = velocity.size // 2
    for index, speed in enumerate(velocity):
        if math.isnan(speed):
            continue
        side = math.copysign(1.0, speed) if speed != 0.0 else (1.0 if index > middle else -1.0)
        weight = load.load_at(record, angle, 0.0, 0.0)
        viscous = friction.damping(record, side, speed)[0] * speed
        level = 0.0
        for _ in range(8):  # the level may depend on the motor torque, which includes it
            level = friction.level(record, side, speed, angle, weight + viscous + side * level)[0]
        result[index] = side * level + viscous
    return result


def _load(models: Mapping[str, Model], missing: Lacking, angle: Signal) -> Characteristic:
    """Torque of spring, weight and all else that loads the shaft over its angle."""
    nodes = np.linspace(*_travel(models["final"], angle), CURVE_POINTS)
    motion = models["final"].actuator.motion
    drawn = travel_factor(motion)
    curves = {name: (drawn * nodes, load_torque(model, nodes)) for name, model in models.items()}
    points = binned(drawn * missing.angle, load_torque(models["final"], missing.angle) + missing.own)
    title = f"load that closes [{unit_of('N.m', motion)}]"
    return Characteristic("load", "spring and load", travel_title(motion), title, curves, points)


def load_torque(model: Model, angle: Signal) -> Signal:
    """Torque that loads the shaft at rest at the start [N.m], positive closes, shape (angles,)."""
    record = model.record()[0]
    return np.array([load.load_at(record, float(each), 0.0, 0.0) for each in angle])


def _sensor(models: Mapping[str, Model], angle: Signal, residual: Signal) -> Characteristic:
    """Place that the nominal scale shows minus the true place, over the true place."""
    nominal, final = models["nominal"], models["final"]
    motion = final.actuator.motion
    drawn = travel_factor(motion)
    low, high = _travel(final, angle)
    shown = np.linspace(low, high, CURVE_POINTS)
    values = _values_at(nominal, shown)
    curves = {}
    for name, model in models.items():
        true = decoded(model, values)
        curves[name] = (drawn * true, drawn * (shown - true))
    true = decoded(final, _values_at(nominal, angle))
    points = binned(drawn * true, drawn * (angle - true + residual))
    return Characteristic(
        "sensor",
        "sensor: shown less true place",
        f"true {travel_title(motion)}",
        travel_title(motion).replace("angle", "deviation").replace("position", "deviation"),
        curves,
        points,
    )


def _values_at(model: Model, angle: Signal) -> Signal:
    """Reading of the linear sensor of `model` at an `angle` [rad], measured unit."""
    origin = float(decoded(model, np.zeros(1))[0])
    return np.asarray((angle - origin) / angle_per_unit(model))


def _plays(model: Model) -> list[Characteristic]:
    """For every play that acts: the place of the driven side while the driving side goes to and fro."""
    found, motion = [], model.actuator.motion
    for effect in EFFECTS:
        if effect.play is None or not effect.acts(model.values):
            continue
        gap = model.values[f"{effect.id}.{effect.play}"]
        there = np.linspace(0.0, 6.0 * gap, CURVE_POINTS)
        driving = np.concatenate([there, there[::-1]])
        driven = np.concatenate([np.maximum(there - gap, 0.0), np.minimum(there[::-1], 5.0 * gap)])
        name = effect.id.replace("_", " ")
        found.append(
            Characteristic(
                effect.id,
                f"{name}: to and fro",
                f"driving side: {travel_title(motion)}",
                f"driven side: {travel_title(motion)}",
                {"final": (travel_factor(motion) * driving, travel_factor(motion) * driven)},
            )
        )
    return found


def _travel(model: Model, angle: Signal) -> tuple[float, float]:
    """The travel from stop to stop [rad]; where there is no stop, as far as the shaft went."""
    actuator = model.actuator
    low, high = float(np.min(angle)), float(np.max(angle))
    return (
        actuator.lower_stop if math.isfinite(actuator.lower_stop) else low,
        actuator.upper_stop if math.isfinite(actuator.upper_stop) else high,
    )


def binned(x: Signal, y: Signal) -> Points:
    """The means of `y` over bins of about equal numbers of samples along `x`, with twice the error of each mean."""
    if x.size < 2 * POINTS_OF_CURVE:
        return Points(x[:0], y[:0], y[:0])
    order = np.argsort(x, kind="stable")
    parts = [(x[part], y[part]) for part in np.array_split(order, POINTS_OF_CURVE)]
    error = [2.0 * float(np.std(values)) / math.sqrt(max(values.size / CORRELATED, 1.0)) for _, values in parts]
    means = [(float(np.mean(place)), float(np.mean(values))) for place, values in parts]
    return Points(np.array([each[0] for each in means]), np.array([each[1] for each in means]), np.array(error))
