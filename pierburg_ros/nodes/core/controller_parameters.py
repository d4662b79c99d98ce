"""Parameters of the controller node beside the settings of the control law."""

from __future__ import annotations

from pierburg_ros.control import SETTINGS
from pierburg_ros.parameter import Parameter as Declaration

CONTROLLER = (
    Declaration("setpoint", 0.0, "wanted shaft angle, as if sent on the topic setpoints", "rad", -100.0, 100.0),
    Declaration(
        "setpoint_file",
        "",
        "CSV with columns time [s since the first Hall sample] and setpoint [rad], followed sample by sample",
        fixed=True,
    ),
    Declaration(
        "hall_timeout",
        0.05,
        "longest time without a Hall sample, by a steady clock, until duty 0 is sent; 0: for ever",
        "s",
        0.0,
        3600.0,
    ),
    Declaration("publish_internals", False, "publish error, PI output, derivative and saturation under ~/"),
)

LAW = tuple(Declaration(s.name, s.default, s.meaning, s.unit, s.minimum, s.maximum) for s in SETTINGS)
"""The control law's settings, as the core declares them."""
