"""Parameters of the monitor node."""

from pierburg_ros.nodes.core.joint import JOINT
from pierburg_ros.parameter import Parameter as Declaration

MONITOR = (
    Declaration("actuator", "pierburg", "name of an actuator, or path of its description", fixed=True),
    Declaration("model", "", "path of a model file; its actuator and values replace the nominal ones", fixed=True),
    Declaration(
        "angle_topic",
        "joint_states",
        "topic of the sensor; joint_states carries the time at which a sample was taken",
        fixed=True,
        choices=("joint_states", "hall_voltage"),
    ),
    Declaration(
        "duty_topic",
        "applied_duty",
        "topic of the duty; applied_duty is what the actuator really obeyed",
        fixed=True,
        choices=("applied_duty", "duty"),
    ),
    Declaration("joint", "", JOINT, fixed=True),
    Declaration("recorder", "recorder", "node asked to split its recording at a finding; empty: none", fixed=True),
    Declaration(
        "tolerance",
        0.05,
        "drift of a parameter that need not be reported, as a fraction of it",
        "1",
        0.0,
        1.0,
        fixed=True,
    ),
    Declaration(
        "misfit_tolerance",
        0.003,
        "what a model may leave of a movement without physics being suspected, as a fraction of the travel",
        "1",
        0.0,
        1.0,
        fixed=True,
    ),
    Declaration(
        "offset_tolerance",
        0.01,
        "offset of the sensor at a stop that need not be reported, as a fraction of the way between the stops",
        "1",
        0.0,
        1.0,
        fixed=True,
    ),
)
