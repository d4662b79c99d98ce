"""A closed loop: the input follows from setpoint and angle by a rule, which says when and in what unit they were.

Where a proportional controller made the input, that rule is nearly exact, whatever physics the actuator lacks. An input
that fits the setpoint and the angle of a moment ago was stamped late, or its controller is slow; what it does to the
shaft decides.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags
from pierburg_ros.audit.explained import BESIDE, Explained, explained
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.audit.slips import Slip
from pierburg_ros.audit.timing import EARLY, stamped_late
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded

EXACT = 0.99
"""Share of the input, or of the error that it follows from, that the rule explains where there is one. Measured: 0.9996
or more of the input with a servo's own loop (n = 8), 0.90 or less where a nonlinear controller made it (n = 8); of the
error beside an effect 0.998 or more where that was put into the servo's channels (n = 29), 0.97 or less beside a lag
that is not there, of a controller with an integral (n = 8)."""
SHARPER = 0.25
"""Share of what the rule leaves as read that it may leave a few samples earlier, to say which is right. Chosen: noise
alone leaves the same at any moment."""
WEIGHED = 0.05
"""How far the weights of setpoint and angle may be apart for both to be in one unit. Chosen: an error is their
difference; those of the servo differ by 4 % at most (n = 8)."""
OTHERWISE = 0.5
"""Share by which they are apart at least where one of them is not in its unit. Chosen: two units differ by a factor of
6.3 or more, a controller may weigh its setpoint somewhat less."""
NO_WORSE = 1.1
"""What the motion may cost, over what it costs as read, for it not to speak against a rule. Chosen: less than one
effect that is missing makes; a servo's late inputs moved back cost 0.4 to 1.07 times as much (n = 16)."""
INSIDE = 0.98
"""Share of its range within which an input is not limited. Chosen: a controller's limit is where it stays for long."""


@dataclass(frozen=True)
class Rule:
    """input = `by_setpoint` setpoint + `by_angle` angle + a constant, `late` samples ago. Of 1 it leaves `left`."""

    late: int
    left: float
    by_setpoint: float
    by_angle: float

    @property
    def weighs_alike(self) -> float:
        """Weight of the angle over that of the setpoint, 1 where the input follows their difference."""
        return -self.by_angle / self.by_setpoint if self.by_setpoint else 0.0


def closed_loop(signals: Signals, given: Explained | None, slips: Iterable[Slip], nominal: Model) -> Fault | None:
    """What the rule of a closed loop says of the times of the input, and of the unit of the angle; None where nothing.

    Only where the motion does not speak against it: a controller may be slow, and weigh its setpoint otherwise.
    """
    found = rule(signals, nominal)
    if found is None:
        return None
    late = found.late * signals.interval
    if found.late > EARLY and found.left <= SHARPER * _at(signals, nominal, 0).left:
        moved = explained(signals.delayed(-late), nominal)
        if given is None or moved.cost <= NO_WORSE * given.cost:
            evidence = f"It follows from setpoint and angle as they were {1e3 * late:.3g} ms before,"
            return stamped_late(signals, late, f"{evidence} by one rule for {100.0 * (1.0 - found.left):.1f} % of it.")
    off = abs(found.weighs_alike - 1.0)
    if off <= WEIGHED:
        return None
    for slip in slips:
        if off <= OTHERWISE and slip.mended.inputs is signals.inputs:
            continue  # another unit of the angle is farther off; exchanged with the input it may be near
        other = rule(slip.mended, nominal) if slip.signal == signals.quantity else None
        if other is None or abs(other.weighs_alike - 1.0) > WEIGHED:
            continue
        if given is None or explained(slip.mended, nominal).cost <= NO_WORSE * given.cost:
            return Fault(signals.name, slip.signal, slip.what, _weighed(signals, found), slip.mend)
    return None


def rule(signals: Signals, nominal: Model) -> Rule | None:
    """The rule by which the input follows from setpoint and angle, at the moment that suits best; None where none."""
    if signals.setpoints is None or signals.quantity == "speed":
        return None
    rules = [_at(signals, nominal, late) for late in range(-BESIDE, BESIDE + 1)]
    best = min(rules, key=lambda each: each.left)
    return best if best.left <= 1.0 - EXACT else None


def _at(signals: Signals, nominal: Model, late: int) -> Rule:
    """The rule from what was `late` samples before, by least squares."""
    past = signals.time - late * signals.interval
    kept = free_of_limits(signals) & (past >= signals.time[0]) & (past <= signals.time[-1])
    angle = np.interp(past[kept], signals.time, decoded(nominal, signals.measured, signals.quantity))
    assert signals.setpoints is not None  # checked before
    setpoint, wanted = signals.setpoints.at(past[kept]), signals.command[kept]
    if wanted.size < 2 * BESIDE or min(np.ptp(setpoint), np.ptp(angle), np.ptp(wanted)) == 0.0:
        return Rule(late, 1.0, 0.0, 0.0)
    known = np.stack([setpoint, angle, np.ones(angle.size)], axis=1)
    weights = np.linalg.lstsq(known, wanted, rcond=None)[0]
    left = float(np.var(wanted - known @ weights) / np.var(wanted))
    return Rule(late, left, float(weights[0]), float(weights[1]))


def free_of_limits(signals: Signals) -> Flags:
    """Samples at which the input is not limited, and acts."""
    command = signals.command
    low, high = float(np.min(command)), float(np.max(command))
    free: Flags = np.abs(command - 0.5 * (low + high)) < 0.5 * INSIDE * (high - low)
    enabled = signals.inputs.enabled
    if enabled is not None:
        place = np.searchsorted(signals.inputs.time, signals.time, side="right") - 1
        free &= enabled[np.maximum(place, 0)]
    return free


def _weighed(signals: Signals, found: Rule) -> str:
    """What the weights say, in numbers."""
    return (
        f"The {signals.input} follows from setpoint and angle by one rule for {100.0 * (1.0 - found.left):.1f} % of it,"
        f" and a unit of the angle weighs {found.weighs_alike:.3g} times as much as one of the setpoint."
    )
