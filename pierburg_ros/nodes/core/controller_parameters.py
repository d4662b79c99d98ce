"""Parameters of the controller node beside the settings of the control law."""

from __future__ import annotations

from pierburg_ros.control import SETTINGS
from pierburg_ros.nodes.core.depth import DEPTH
from pierburg_ros.nodes.core.joint import JOINT
from pierburg_ros.nodes.core.joint_command import ARRAYS
from pierburg_ros.nodes.core.protection.fallback import CHOICES
from pierburg_ros.parameter import Parameter as Declaration

CONTROLLER = (
    DEPTH,
    Declaration(
        "actuator",
        "pierburg",
        "name of an actuator, or path of its description, whose numbers set the limits of the protections",
        fixed=True,
    ),
    Declaration("hardware_id", "", "name of the actuator on /diagnostics; empty: that of its description", fixed=True),
    Declaration(
        "autostart", True, "be active at once; otherwise wait for the transitions of a managed node", fixed=True
    ),
    Declaration("exclusive", True, "send no duty while another node does; take over when it is gone"),
    Declaration("joint", "", JOINT, fixed=True),
    Declaration(
        "command",
        "position",
        "what joint_commands asks for: a position [rad] that the control law follows, or by effort a duty [1] in the"
        " place of the law's",
        fixed=True,
        choices=tuple(ARRAYS),
    ),
    Declaration(
        "command_timeout", 0.05, "with command duty: time without joint_commands after which it is 0", "s", 0.0, 3600.0
    ),
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
        "longest time without a new Hall sample that can be true, by a steady clock; 0: for ever",
        "s",
        0.0,
        3600.0,
    ),
    Declaration("publish_internals", False, "publish error, PI output, derivative and saturation under ~/"),
    Declaration("longest_step", 0.1, "longer times between two samples count as this for the law", "s", 0.001, 3600.0),
)

PROTECTION = (
    Declaration(
        "hall_margin", 0.05, "how far a healthy sensor may be beyond its ends, share of their distance", "1", 0.0, 10.0
    ),
    Declaration("top_speed", 0.0, "fastest the shaft can turn; 0: derived from the actuator", "rad/s", 0.0, 1e6),
    Declaration("angle_timeout", 0.03, "longest time for which bad samples are passed over", "s", 0.0, 3600.0),
    Declaration("frozen_retry", 1.0, "time until a frozen sensor is first tried again; 0: never", "s", 0.0, 3600.0),
    Declaration(
        "on_fault",
        "release",
        "what a lost angle is answered with: duty 0, the last duty, or a closing one",
        choices=CHOICES,
    ),
    Declaration("hold_time", 1.0, "longest time for which on_fault hold keeps the duty, then 0", "s", 0.0, 3600.0),
    Declaration("close_duty", 0.2, "size of the negative duty of on_fault close", "1", 0.0, 1.0),
)

WINDING = (
    Declaration(
        "rated_current", 0.0, "current the winding bears for ever; 0: a third of the stall current", "A", 0.0, 1e4
    ),
    Declaration(
        "thermal_time_constant",
        20.0,
        "time constant of the winding's heat in the stall protection; 0: no protection",
        "s",
        0.0,
        1e6,
    ),
)
"""Stall protection, the same for controller and plant. 20 s is an assumption: small windings have 10 to 30 s."""

LAW = tuple(Declaration(s.name, s.default, s.meaning, s.unit, s.minimum, s.maximum) for s in SETTINGS)
"""The control law's settings, as the core declares them."""
