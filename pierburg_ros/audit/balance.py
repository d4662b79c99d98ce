"""Inputs that balance other torques: the motion is too slow to show them, the torques along it do."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.audit.explained import CREDIBLE
from pierburg_ros.audit.signals import Signals
from pierburg_ros.estimation.shooting import spread
from pierburg_ros.estimation.torque_balance import goes_round, over_a_turn
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.plant.simulate import motor_torque
from pierburg_ros.recording.noise import noise_of

BALANCED = 0.5
"""Torque of inertia, as a share of the variation of the input's, up to which the input balances other torques and its
share in the acceleration is not told. Derived: where these other torques are unknown, the velocities of a right model
then correlate by half at most, which is what is asked for (`ENOUGH`)."""

MADE_UP = 0.5
"""Share of the variation of the input's torque that inertia, friction and what repeats itself with every turn make up,
from which the input is that of the motion. Chosen: half, as of the motion; right inputs of a real rotor reach 0.85 or
more (n = 27, effects put in), those of other runs 0.23 or less where the shaft goes round several times (n = 2)."""


def in_balance(signals: Signals, nominal: Model) -> bool:
    """Whether the input of a current or torque drive balances other torques, and hardly accelerates anything.

    The angle then says what holds the shaft, and a model that lacks that torque moves at other moments than the shaft.
    """
    return nominal.actuator.drive != "voltage" and _accelerating(signals, nominal) <= BALANCED


def made_up(signals: Signals, nominal: Model) -> bool:
    """Whether torques along a motion that goes round make up those of its input, as large as the actuator has them.

    Then the input is that of the motion, be the shaft ever so slow. How large they are is taken from the description of
    the actuator: so slow a motion hardly tells an inertia, and a diagnosed model may be far off. Within a single turn
    any smooth input passes, for nothing comes twice.
    """
    if not goes_round(nominal, signals.measured, signals.quantity):
        return False
    seen = np.ones(signals.time.size, dtype=bool)
    balance = over_a_turn(nominal, [(signals.inputs, signals.time, signals.measured, seen)])
    driven = float(np.var(motor_torque(nominal, signals.inputs, signals.time)))
    described, off = Model.nominal(nominal.actuator), math.exp(CREDIBLE)
    friction, resisted = described.values["coulomb_friction"], balance.resistance
    as_described = friction / off <= resisted <= off * friction if friction > 0.0 else resisted > 0.0
    return balance.left**2 <= (1.0 - MADE_UP) * driven and as_described and _accelerating(signals, described) <= off


def _accelerating(signals: Signals, nominal: Model) -> float:
    """Torque of inertia, as described, as a share of the variation of the input's."""
    order = 1 if signals.quantity == "speed" else 2
    noise = noise_of(signals.time, signals.measured)
    acceleration = spread(signals.measured, order, signals.interval, noise) * abs(angle_per_unit(nominal))
    driven = float(np.std(motor_torque(nominal, signals.inputs, signals.time)))
    return nominal.values["total_inertia"] * acceleration / driven if driven > 0.0 else math.inf
