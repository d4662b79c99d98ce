"""Several recordings of one actuator: the numbers found in one must hold in the others."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.audit.explained import Explained
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model

LEFT = 0.15
"""Share of the motion of a recording that the numbers of another leave unexplained from which they are of two actuators.
PLACEHOLDER"""
WORSE = 5.0
"""So many times what its own numbers leave, at least. PLACEHOLDER"""

Pair = tuple[Signals, Explained]


def apart(pairs: Sequence[Pair], nominal: Model) -> list[Fault]:
    """The recordings that are not of the actuator of the first one."""
    return []
