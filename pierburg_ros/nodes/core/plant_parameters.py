"""Parameters of the plant node beside those of the physics."""

from pierburg_ros.nodes.core.depth import DEPTH
from pierburg_ros.nodes.core.joint import JOINT
from pierburg_ros.parameter import Parameter as Declaration

PLANT = (
    DEPTH,
    Declaration("actuator", "pierburg", "name of an actuator, or path of its description", fixed=True),
    Declaration("model", "", "path of a model file; its actuator and values replace the nominal ones", fixed=True),
    Declaration(
        "formulation",
        "exact",
        "which simulator moves the shaft; 'textbook' is the slower, independent one of the blind trials",
        fixed=True,
        choices=("exact", "textbook"),
    ),
    Declaration("joint", "", JOINT, fixed=True),
    Declaration("hardware_id", "", "name of the actuator on /diagnostics; empty: that of its description", fixed=True),
    Declaration("rate", 500.0, "ticks per second", "Hz", 1.0, 2000.0),
    Declaration(
        "simulated_time",
        False,
        "publish /clock and count time in ticks, instead of following the clock",
        fixed=True,
    ),
    Declaration("time_factor", 1.0, "simulated seconds per second, in simulated time; 0 runs free", "1", 0.0, 1000.0),
    Declaration("lockstep", False, "in simulated time, wait for one duty after every sample; implies it", fixed=True),
    Declaration(
        "command_timeout",
        0.05,
        "longest time a duty stays in force without a new one; 0: for ever",
        "s",
        0.0,
        3600.0,
    ),
    Declaration("hall_voltage_noise", 0.0, "standard deviation of the noise added to the Hall voltage", "V", 0.0, 1.0),
    Declaration("seed", 0, "seed of the noise", minimum=0, maximum=2**31 - 1, fixed=True),
    Declaration(
        "velocity_time_constant",
        0.01,
        "time constant of the filter on the derivative of the decoded angle, for joint_states",
        "s",
        0.0,
        10.0,
    ),
)
