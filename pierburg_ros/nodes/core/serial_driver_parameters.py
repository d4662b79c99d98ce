"""Parameters of the serial driver node."""

from pierburg_ros.nodes.core.depth import DEPTH
from pierburg_ros.nodes.core.joint import JOINT
from pierburg_ros.parameter import Parameter as Declaration

SERIAL_DRIVER = (
    DEPTH,
    Declaration("port", "/dev/ttyACM0", "serial line of the device", fixed=True),
    Declaration("speed", 921600, "speed of the line; lines over USB ignore it", "baud", 50, 4000000, fixed=True),
    Declaration("actuator", "pierburg", "name of an actuator, or path of its description", fixed=True),
    Declaration("joint", "", JOINT, fixed=True),
    Declaration(
        "command_timeout",
        0.05,
        "longest time the device holds a duty without a new one; 0: for ever",
        "s",
        0.0,
        60.0,
    ),
    Declaration("silence_timeout", 0.5, "time without a state after which the device is reported", "s", 0.01, 60.0),
    Declaration(
        "velocity_time_constant",
        0.01,
        "time constant of the filter on the derivative of the decoded angle, for joint_states",
        "s",
        0.0,
        10.0,
    ),
)
