"""Parameters of the recorder node, and the topics it records when told no others."""

from pierburg_ros.parameter import Parameter as Declaration

FLOAT64 = "std_msgs/msg/Float64"
BOOL = "std_msgs/msg/Bool"
DEFAULT_TOPICS = {
    "hall_voltage": FLOAT64,
    "applied_duty": FLOAT64,
    "joint_states": "sensor_msgs/msg/JointState",
    "duty": FLOAT64,
    "active_setpoint": FLOAT64,
    "controller/error": FLOAT64,
    "controller/pi_output": FLOAT64,
    "controller/derivative": FLOAT64,
    "controller/saturated": BOOL,
    "supply_voltage": FLOAT64,
    "temperature": FLOAT64,
    "enabled": BOOL,
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/parameter_events": "rcl_interfaces/msg/ParameterEvent",
    "/rosout": "rcl_interfaces/msg/Log",
    "/clock": "rosgraph_msgs/msg/Clock",
}
"""Topics and their types, known beforehand so that nothing is missed while the graph is being discovered.

Commands (`setpoints`, `~/set_parameter`) are not among them: `ros2 topic pub --once` sends as soon as it knows one
reader, and that one must be the node that obeys. What they did is in `active_setpoint` and `/parameter_events`.
"""

RECORDER = (
    Declaration(
        "output",
        "recordings/",
        "file (.mcap) or folder of the recording; in a folder the name is the time",
        fixed=True,
    ),
    Declaration("form", "mcap", "a bare file, or a rosbag2 directory", fixed=True, choices=("mcap", "rosbag2")),
    Declaration("topics", list(DEFAULT_TOPICS), "topics to record, of any installed type", fixed=True),
    Declaration(
        "parameters_of",
        ["plant", "controller"],
        "nodes whose parameter values begin the file, for people",
        fixed=True,
    ),
    Declaration("flush_interval", 0.2, "time after which messages are on disk at the latest", "s", 0.02, 10.0),
)
