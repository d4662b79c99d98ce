"""From a measured value back to the angle that it shows, by the characteristic of a model's sensor."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pierburg_ros.plant.model import Model
from pierburg_ros.plant.torques import sensor


def decoded(model: Model, measured: ArrayLike, quantity: str | None = None) -> NDArray[np.float64]:
    """Angle [rad] that each of the `measured` values shows, same shape; `quantity`: what they are, if not the model's.

    Of a speed sensor it is the velocity [rad/s].
    Play and lag of the sensor are not undone: they depend on what was before.
    """
    record, is_angle = model.record()[0], _is_angle(model, quantity)
    values = np.asarray(measured, dtype=np.float64)
    return np.asarray(sensor.decode_all(record, values.ravel(), is_angle)).reshape(values.shape)


def decoded_value(model: Model, measured: float, quantity: str | None = None) -> float:
    """`decoded` of one value: a fit asks for it before every simulation."""
    return float(sensor.decode(model.record()[0], measured, _is_angle(model, quantity)))


def encoded(model: Model, angle: ArrayLike) -> NDArray[np.float64]:
    """Hall voltage [V] that a straight sensor with the ends of `model` shows at each `angle` [rad], same shape."""
    record = model.record()[0]
    return np.asarray(record["hall_voltage_closed"] + sensor.per_radian(record) * np.asarray(angle, dtype=np.float64))


def trail(model: Model) -> tuple[float, float]:
    """Lag [s] and play [rad] by which the sensor of `model` is behind a shaft that moves evenly."""
    lag, play = sensor.trail(model.record()[0])
    return float(lag), float(play)


def begun(model: Model, shown: NDArray[np.float64], quantity: str) -> NDArray[np.float64]:
    """The state of a shaft where samples of an angle show some values, shape (starts, 4), as `simulate` begins with it.

    `shown`, shape (starts, 5), are the level of the samples, their rate [1/s], their curvature [1/s^2], the margin
    within which they tell a stop, and whether they came rising (+1) or falling (-1). Exactly on a stop where the margin
    allows it.
    """
    return np.asarray(sensor.begun(model.record()[0], shown, _is_angle(model, quantity)))


def turned(model: Model, time: ArrayLike, measured: ArrayLike, quantity: str) -> NDArray[np.float64]:
    """Angle [rad] at each `time` [s] that the `measured` values show; of a speed counted from the first sample."""
    return way(decoded(model, measured, quantity), time, quantity)


def way(values: NDArray[np.float64], time: ArrayLike, quantity: str) -> NDArray[np.float64]:
    """`values` of a measured quantity, or what a speed adds up to from the first `time` [s] on."""
    if quantity != "speed":
        return values
    # takes a quarter of a second to load
    from scipy.integrate import cumulative_trapezoid

    return np.asarray(cumulative_trapezoid(values, time, initial=0.0))


def angle_per_unit(model: Model) -> float:
    """Angle [rad] that one unit of the measured quantity stands for, on average over the span.

    Of a speed sensor it is the velocity [rad/s].
    """
    record = model.record()[0]
    return 1.0 / float(record["sensor_scale"] if _is_angle(model, None) else sensor.per_radian(record))


def _is_angle(model: Model, quantity: str | None) -> bool:
    return (quantity or model.actuator.quantity) != "hall_voltage"
