"""Motions too slow for their input to show in them: the shaft creeps from one balance to the next."""

from __future__ import annotations

import numpy as np

from pierburg_ros.audit.signals import Signals
from pierburg_ros.estimation.shooting import spread
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.plant.simulate import motor_torque
from pierburg_ros.recording.noise import noise_of

BALANCED = 0.5
"""Torque of inertia, as a share of the variation of the input's, up to which the input balances other torques and its
share in the acceleration is not told. Derived: where these other torques are unknown, the velocities of a right model
then correlate by half at most, which is what is asked for (`ENOUGH`)."""


def in_balance(signals: Signals, nominal: Model) -> bool:
    """Whether the input of a current or torque drive balances other torques, and hardly accelerates anything.

    The angle then says what holds the shaft, and a model that lacks that torque moves at other moments than the shaft.
    """
    if nominal.actuator.drive == "voltage":
        return False
    order = 1 if signals.quantity == "speed" else 2
    noise = noise_of(signals.time, signals.measured)
    acceleration = spread(signals.measured, order, signals.interval, noise) * abs(angle_per_unit(nominal))
    inertia = nominal.values["total_inertia"] * acceleration
    return inertia <= BALANCED * float(np.std(motor_torque(nominal, signals.inputs, signals.time)))
