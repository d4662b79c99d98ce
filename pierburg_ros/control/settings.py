"""What can be set on the controller: every parameter declared once, with default, unit, range and meaning.

The ROS parameters of the node, the parameter file of `pierburg tune` and the record that the compiled law
reads all derive from the fields below.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

import numpy as np

from pierburg_ros.errors import InputError, near
from pierburg_ros.parameter import Parameter


def declared(default: float, unit: str, minimum: float, maximum: float, meaning: str) -> Any:
    """A dataclass field that carries its unit, range and meaning."""
    metadata = {"default": default, "unit": unit, "minimum": minimum, "maximum": maximum, "meaning": meaning}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True)
class Settings:
    """Settings of the PIFLC; refuses a value that is not finite or out of range, and sets out of order.

    The default gains, supports and sets are what `pierburg tune --seed 1` found for 500 Hz, see docs/control.md.
    """

    proportional_gain: float = declared(1.0, "1", 0.0, 100.0, "PI output [V] per error [V]")
    integral_gain: float = declared(10.6, "1/s", 0.0, 1e4, "rate of the PI output [V/s] per error [V]")
    integral_dead_zone: float = declared(0.0102, "V", 0.0, 0.5, "error within which the integrator rests")
    derivative_time_constant: float = declared(
        0.00102, "s", 0.0, 1.0, "time constant of the low-pass filter on the derivative of the error"
    )
    pi_output_support: float = declared(0.141, "V", 1e-3, 1e3, "PI output at which its sets N and P reach 1")
    derivative_support: float = declared(
        536.0, "V/s", 1e-2, 1e9, "derivative of the error at which its sets N and P reach 1"
    )
    negative_big: float = declared(-1.0, "1", -1.0, 1.0, "duty at the centre of output set NB")
    negative: float = declared(-0.56, "1", -1.0, 1.0, "duty at the centre of output set N")
    zero: float = declared(0.0, "1", -1.0, 1.0, "duty at the centre of output set Z")
    positive: float = declared(0.906, "1", -1.0, 1.0, "duty at the centre of output set P")
    positive_big: float = declared(1.0, "1", -1.0, 1.0, "duty at the centre of output set PB")
    duty_minimum: float = declared(-1.0, "1", -1.0, 0.0, "lowest duty given out")
    duty_maximum: float = declared(1.0, "1", 0.0, 1.0, "highest duty given out")
    transfer_time: float = declared(
        0.01, "s", 1e-6, 10.0, "time constant of the duty's transition after a start or a change"
    )
    predictor_delay: float = declared(0.0, "s", 0.0, 10.0, "delay that the predictor looks over; 0: none")
    predictor_lag: float = declared(0.0, "s", 0.0, 10.0, "lag of the sensor that the predictor makes up for; 0: none")
    predictor_speed: float = declared(0.0, "V/s", 0.0, 1e6, "Hall voltage per time and duty beyond load and friction")
    predictor_friction: float = declared(0.0, "1", 0.0, 1.0, "duty that overcomes friction")
    load_closed: float = declared(0.0, "1", -1.0, 1.0, "duty that carries the load at the closed stop")
    load_open: float = declared(0.0, "1", -1.0, 1.0, "duty that carries the load at the open stop")
    load_share: float = declared(
        0.0, "1", 0.0, 2.0, "share of that duty which is scheduled over the setpoint; 0: left to the integrator"
    )
    angle_closed: float = declared(0.0, "rad", -100.0, 100.0, "shaft angle at the closed stop")
    angle_open: float = declared(math.pi / 2, "rad", -100.0, 100.0, "shaft angle at the open stop")
    hall_voltage_closed: float = declared(0.42, "V", -100.0, 100.0, "Hall voltage at the closed stop")
    hall_voltage_open: float = declared(4.52, "V", -100.0, 100.0, "Hall voltage at the open stop")

    def __post_init__(self) -> None:
        for setting in SETTINGS:
            setting.accepted(getattr(self, setting.name))
        centres = [self.negative_big, self.negative, self.zero, self.positive, self.positive_big]
        if sorted(set(centres)) != centres:
            raise InputError(f"The output sets NB, N, Z, P, PB lie at {centres}; give them in rising order.")
        for quantity in ("angle", "hall_voltage"):
            if getattr(self, f"{quantity}_closed") >= getattr(self, f"{quantity}_open"):
                raise InputError(f"{quantity}_closed is not below {quantity}_open; give them in rising order.")

    def with_values(self, values: Mapping[str, float]) -> Settings:
        """These settings with some replaced, checked together; refuses names that do not exist."""
        known = [each.name for each in fields(self)]
        for name in values:
            if name not in known:
                raise InputError(
                    f"The controller has no setting {name!r}; it has {', '.join(known)}.{near(name, known)}"
                )
        return replace(self, **values)

    def record(self) -> Any:
        """The settings as the record that the compiled controller reads."""
        values = tuple(asdict(self).values())
        return np.rec.array([values], dtype=[(each.name, np.float64) for each in fields(self)])[0]


SETTINGS: tuple[Parameter, ...] = tuple(Parameter(each.name, **each.metadata) for each in fields(Settings))
"""Their declarations, in the order of the fields."""
