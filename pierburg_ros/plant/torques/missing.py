"""The load torque that a model lacks for a motion to be as it is: its balance of torques, read backwards."""

from __future__ import annotations

import numpy as np

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.torques.friction import damping, level
from pierburg_ros.plant.torques.load import load_at, ripple


@kernel
def missing(p, motor, time, angle, velocity, acceleration):
    """What is missing in the load [N.m], positive closes, while the shaft slides; all of shape (moments,).

    `motor` is the motor torque at the shaft [N.m]. Equation (6) of the paper, solved for the load.
    """
    torque = np.empty(time.size)
    for i in range(time.size):
        direction = np.sign(velocity[i])
        known = load_at(p, angle[i], velocity[i], time[i]) + ripple(p, angle[i])
        friction = direction * level(p, direction, velocity[i], angle[i], motor[i])[0]
        resisting = friction + damping(p, direction, velocity[i])[0] * velocity[i]
        torque[i] = motor[i] - known - resisting - p.total_inertia * acceleration[i]
    return torque
